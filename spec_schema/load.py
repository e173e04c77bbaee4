"""A spec file, read and checked as far as it can be by itself: the one way to load a spec."""

from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Final, final

from spec_schema.characters import LARGEST, decode, too_large
from spec_schema.diagnostics import Diagnostic, Severity, SpecError, first_ones
from spec_schema.kinds import MODELS, AnySpec
from spec_schema.mistake import Mistake
from spec_schema.node import Plain, plain
from spec_schema.places import Path, Places, dotted
from spec_schema.salvage import salvage
from spec_schema.shape import check_shape
from spec_schema.source import Source, Span
from spec_schema.suggest import did_you_mean, nearest
from spec_schema.yaml_reader import read

TELLING: Final = {
    "project": {"specs", "traces"},
    "architecture": {"nodes", "channels"},
    "arbiter": {"reads", "choices", "by"},
    "body": {"drive", "sensors", "mass"},
    "world": {"arena", "things", "lights", "scatter"},
    "scenario": {"world", "robots", "duration", "require"},
}
"""Keys that tell the kind of a spec that does not say it."""


@final
@dataclass(frozen=True, slots=True)
class Loaded:
    """A spec, its text, and where everything in it stands."""

    source: Source
    spec: AnySpec
    places: Places

    def error(
        self,
        code: str,
        path: Path,
        message: str,
        help: str = "",  # noqa: A002  # the word of the format
        *,
        label: str = "",
        within: tuple[int, int] | None = None,
        key: bool = False,
    ) -> Diagnostic:
        """An error at the value of `path`, at its key, or at characters `within` its text."""
        span = _span(self.places, path, within, key=key)
        return Diagnostic(
            code, Severity.ERROR, message, self.source, span, self.places.dotted(path), help, label
        )

    def warning(
        self,
        code: str,
        path: Path,
        message: str,
        help: str = "",  # noqa: A002  # the word of the format
        *,
        label: str = "",
        within: tuple[int, int] | None = None,
        key: bool = False,
    ) -> Diagnostic:
        """A warning, placed like an error."""
        return replace(
            self.error(code, path, message, help, label=label, within=within, key=key),
            severity=Severity.WARNING,
        )

    def origin(self, path: Path) -> str:
        """`file:line:column` of the key at `path`, for the parts of a program."""
        return self.places.origin(path)


@final
@dataclass(frozen=True, slots=True)
class Examined:
    """A spec with its mistakes, and as much of it as can be checked on.

    loaded: the spec, without the parts that are wrong; None where too little is left.
    lost: the declared names that were taken out; nothing more can be said about them.
    """

    mistakes: tuple[Diagnostic, ...]
    loaded: Loaded | None
    lost: frozenset[str]


def load(path: FilePath) -> Loaded:
    """Read and check a spec file; raises SpecError with everything that is wrong with its shape."""
    return _sound(examine(path))


def load_source(source: Source) -> Loaded:
    """Check a spec's text; raises SpecError with everything that is wrong with its shape."""
    return _sound(examine_source(source))


def examine(path: FilePath, wanted: str = "behavior") -> Examined:
    """Read a spec file as far as it can be read; raises SpecError where it is no YAML for us.

    wanted: the kind that it is taken for where nothing in it tells.
    """
    name = str(path)
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST + 1)
    except OSError as error:
        raise SpecError([_unreadable(path, error)]) from error
    if len(data) > LARGEST:
        raise SpecError([too_large(Source(name, ""), path.stat().st_size)])
    source, problems = decode(name, data)
    if problems:
        raise SpecError(problems)
    return examine_source(source, wanted)


def examine_source(source: Source, wanted: str = "behavior") -> Examined:
    """Check a spec's text as far as possible; raises SpecError where it is no YAML for us."""
    root = read(source)
    places = Places(source, root)
    data = {name: plain(entry.value) for name, entry in root.entries.items()}
    model = _model_of(data, wanted)
    shape = check_shape(model, data)
    if shape.spec is not None:
        return Examined((), Loaded(source, shape.spec, places), frozenset())
    mistakes = first_ones(_diagnostic(places, mistake) for mistake in shape.mistakes)
    places = replace(places, renamed=shape.written)
    rest = salvage(model, data)
    mistakes = first_ones((*mistakes, *(_diagnostic(places, found) for found in rest.hidden)))
    if rest.spec is None:
        return Examined(mistakes, None, frozenset())
    left = replace(places, kept=rest.kept)
    return Examined(mistakes, Loaded(source, rest.spec, left), rest.lost)


def _sound(examined: Examined) -> Loaded:
    if examined.mistakes or examined.loaded is None:
        raise SpecError(examined.mistakes)
    return examined.loaded


def _model_of(data: dict[str, Plain], wanted: str) -> type[AnySpec]:
    """The model that the document is meant for, even where it does not say so."""
    kind = data.get("kind")
    meant = nearest(kind, MODELS) if isinstance(kind, str) else None
    looks_like = (kind for kind, keys in TELLING.items() if keys & data.keys())
    return MODELS[meant or next(looks_like, wanted)]


def _diagnostic(places: Places, mistake: Mistake) -> Diagnostic:
    span, label = _span(places, mistake.at, None, key=mistake.on_key), ""
    if mistake.code == "S101":
        span = places.value(mistake.at)
        span, label = Span(span.line, span.column, span.line, span.column + 1), "in this mapping"
    at = dotted(places.written(mistake.at))
    return Diagnostic(
        mistake.code, Severity.ERROR, mistake.message, places.source, span, at, mistake.help, label
    )


def _span(places: Places, path: Path, within: tuple[int, int] | None, *, key: bool) -> Span:
    if within is not None:
        return places.within(path, *within, key=key)
    return places.key(path) if key else places.value(path)


def _unreadable(path: FilePath, error: OSError) -> Diagnostic:
    if isinstance(error, FileNotFoundError):
        message = "there is no such file"
        beside = [p.name for p in path.parent.glob("*.y*ml")] if path.parent.is_dir() else []
        remedy = did_you_mean(path.name, sorted(beside))
    elif isinstance(error, IsADirectoryError):
        message, remedy = "this is a folder, not a file", f"name a file in it: {path}/NAME.yaml"
    else:
        message, remedy = f"the file can't be read: {error.strerror}", ""
    return Diagnostic("S015", Severity.ERROR, message, Source(str(path), ""), None, help=remedy)
