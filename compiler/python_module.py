"""The user's own Python as a field: found beside the spec, called with arrays, its answer checked.

This is the only place where code of a behavior's author is run, and only `compile_loaded` comes
here, past `refuse_module`.
"""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from compiler.tabulate import Sampler
from runtime.arrays import Array
from runtime.user_code import load_module
from spec_schema.diagnostics import SpecError
from spec_schema.field_forms import Module
from spec_schema.load import Loaded


class ModuleError(Exception):
    """The user's function can't be found or didn't give a field: a sentence, and a remedy."""

    def __init__(self, message: str, remedy: str) -> None:
        self.message, self.remedy = message, remedy
        super().__init__(message)


def refuse_module(loaded: Loaded, form: Module) -> None:
    """Stops before the code of a field is run that the user has not allowed.

    Raises:
        SpecError: always (V336).
    """
    message = f"this field is Python code, {form.call}, which is run only where it is allowed"
    remedy = (
        "read that code; then `specc compile`, `specc simulate` and `specc check --claims` run it "
        "with --allow-code, and what is compiled holds a table, which every command takes"
    )
    raise SpecError([loaded.error("V336", ("field", "module"), message, remedy, key=True)])


def sampler(call: str, beside: Path, over: tuple[str, ...], driven: tuple[str, ...]) -> Sampler:
    """The function `package.module:name` as a sampler: (N, d) in, (N, m) out, SI units.

    The function takes each variable of `over` as a keyword, an array (N,), and returns a dict with
    an array for each driven variable.
    """
    function = _found(call, beside)

    def sample(points: Array) -> Array:
        arguments = {name: points[:, i].copy() for i, name in enumerate(over)}
        try:
            answer = function(**arguments)
        except (Exception, SystemExit) as error:
            raise ModuleError(
                f"{call} raised {type(error).__name__}: {error}",
                f"it is called as {call.partition(':')[2]}({', '.join(over)}) with arrays",
            ) from error
        return _checked(call, answer, driven, len(points))

    return sample


def _found(call: str, beside: Path) -> Callable[..., object]:
    module_name, _, name = call.partition(":")
    if not module_name or not name:
        raise ModuleError(f"'{call}' is not package.module:function", "write `call: spiral:field`")
    try:
        module = load_module(module_name, beside)
    except (Exception, SystemExit) as error:
        raise ModuleError(
            f"{module_name} can't be imported ({type(error).__name__}: {error})",
            "it is looked for beside the spec and among the installed packages",
        ) from error
    function: Callable[..., object] | None = getattr(module, name, None)
    if not callable(function):
        raise ModuleError(
            f"{module_name} has no function {name}", f"define `def {name}(...)` there"
        )
    return function


def _checked(call: str, answer: object, driven: tuple[str, ...], count: int) -> Array:
    if not isinstance(answer, Mapping) or set(answer) != set(driven):
        got = ", ".join(map(str, answer)) if isinstance(answer, Mapping) else type(answer).__name__
        raise ModuleError(
            f"{call} must return a dict with a rate for each of {', '.join(driven)} (got {got})",
            "return {" + ", ".join(f'"{name}": ...' for name in driven) + "}",
        )
    try:
        columns = [np.broadcast_to(np.asarray(answer[n], dtype=float), (count,)) for n in driven]
    except (TypeError, ValueError) as error:
        raise ModuleError(
            f"{call} returned something that is not an array of {count} numbers: {error}",
            "return arrays of the same length as the arguments, or single numbers",
        ) from error
    return np.stack(columns, axis=-1)
