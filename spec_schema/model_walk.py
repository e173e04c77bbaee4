"""What the models say about a place: its keys, its words, an example of what belongs there."""

from collections.abc import Mapping
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, RootModel
from pydantic.fields import FieldInfo

from spec_schema.places import Path


def keys_at(model: type[BaseModel], path: Path) -> tuple[str, ...]:
    """The keys that the mapping at `path` may have; none where it may have any."""
    found = _model_at(model, path)
    return () if found is None else tuple(_by_key(found))


def example_at(model: type[BaseModel], path: Path) -> object:
    """An example of the value at `path`, or None."""
    owner = _model_at(model, path[:-1]) if path else None
    field = _by_key(owner).get(str(path[-1])) if owner else None
    return field.examples[0] if field and field.examples else None


def choices_at(model: type[BaseModel], path: Path) -> tuple[str, ...]:
    """The words that may stand at `path`."""
    annotation: Any = model
    for step in path:
        annotation = _step_into(_bare(annotation), step)
    bare = _bare(annotation)
    return get_args(bare) if get_origin(bare) is Literal else ()


def lengths_at(model: type[BaseModel], path: Path) -> tuple[int | None, int | None]:
    """The least and the largest length of the list or mapping at `path`, where there are limits."""
    owner = _model_at(model, path[:-1])
    field = _by_key(owner).get(str(path[-1])) if owner else None
    limits: list[Any] = field.metadata if field else []
    least = next((limit.min_length for limit in limits if hasattr(limit, "min_length")), None)
    most = next((limit.max_length for limit in limits if hasattr(limit, "max_length")), None)
    return least, most


def _by_key(model: type[BaseModel]) -> dict[str, FieldInfo]:
    return {field.alias or name: field for name, field in model.model_fields.items()}


def _model_at(model: type[BaseModel], path: Path) -> type[BaseModel] | None:
    """The model of the mapping at `path`."""
    annotation: Any = model
    for step in path:
        annotation = _step_into(_bare(annotation), step)
    bare = _bare(annotation)
    return bare if _is_model(bare) else None


def _step_into(annotation: Any, step: str | int) -> Any:
    """The annotation of one part of a value: None where it has no such part."""
    if _is_model(annotation):
        field = _by_key(annotation).get(str(step))
        return field.annotation if field else None
    parts = get_args(annotation)
    if not parts:
        return None
    return parts[-1] if get_origin(annotation) is Mapping else parts[0]


def _bare(annotation: Any) -> Any:
    """The annotation without `Annotated`, `| None` and the shell of a root model."""
    while True:
        origin = get_origin(annotation)
        if origin is Annotated:
            annotation = get_args(annotation)[0]
        elif origin in (Union, UnionType):
            annotation = next(part for part in get_args(annotation) if part is not type(None))
        elif isinstance(annotation, type) and issubclass(annotation, RootModel):
            annotation = annotation.model_fields["root"].annotation
        else:
            return annotation


def _is_model(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)
