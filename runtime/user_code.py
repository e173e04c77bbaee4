"""Python of the user's own: found beside the spec, and run only where the user has allowed it."""

import importlib
import importlib.util
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import TypeAlias

Callee: TypeAlias = Callable[..., object]


class UserCodeError(Exception):
    """The user's code may not be run, can't be found, raised, or gave what it should not.

    The text is a sentence for the user.
    """


def load_callee(text: str, beside: Path) -> Callee:
    """What `package.module:name` names: a function or class, beside the spec or installed.

    Raises:
        UserCodeError: it can't be found or imported.
    """
    module_name, _, name = text.partition(":")
    try:
        module = load_module(module_name, beside)
    except (Exception, SystemExit) as error:
        raise UserCodeError(
            f"{module_name} can't be imported ({type(error).__name__}: {error}); it is looked for "
            "beside the spec or artifact and among the installed packages"
        ) from error
    found: Callee | None = getattr(module, name, None)
    if not callable(found):
        raise UserCodeError(f"{module_name} has no function {name}; define `def {name}(...)` there")
    return found


def where_is(text: str, beside: Path) -> str:
    """The file that `load_callee` would run, or which installed package, in words."""
    module_name = text.partition(":")[0]
    path = _file_of(module_name, beside)
    return str(path) if path.is_file() else f"there is no {path}, so an installed package"


def call(text: str, callee: Callee, *arguments: object) -> object:
    """What the user's function returns.

    Raises:
        UserCodeError: it raised something.
    """
    try:
        return callee(*arguments)
    except (Exception, SystemExit) as error:
        raise UserCodeError(f"{text} raised {type(error).__name__}: {error}") from error


def load_module(name: str, beside: Path) -> ModuleType:
    """The module from its file beside the spec, read anew; else the installed one.

    Raises:
        Exception: whatever it raises while it is imported.
    """
    path = _file_of(name, beside)
    if not path.is_file():
        return importlib.import_module(name)
    spec = importlib.util.spec_from_file_location(f"_of_a_spec_{name.replace('.', '_')}", path)
    assert spec is not None, "a .py file has a loader"
    assert spec.loader is not None, "a .py file has a loader"
    module = importlib.util.module_from_spec(spec)
    # Dataclasses look their module up by name while it is imported.
    sys.modules[spec.name] = module
    try:
        with _importable(beside):
            spec.loader.exec_module(module)
    except BaseException:
        sys.modules.pop(spec.name, None)
        raise
    return module


def _file_of(module: str, beside: Path) -> Path:
    return beside / Path(*module.split(".")).with_suffix(".py")


@contextmanager
def _importable(folder: Path) -> Iterator[None]:
    """Within it the modules beside the spec can import one another."""
    before = list(sys.path)
    sys.path.insert(0, str(folder))
    importlib.invalidate_caches()
    try:
        yield
    finally:
        sys.path[:] = before
