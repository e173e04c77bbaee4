"""The file of a behavior spec, compiled; of one that can't be read, all that is wrong is told."""

from pathlib import Path

from compiler.check import check_examined
from compiler.compile import Compiled, Judge, compile_loaded
from runtime.progress import Progress
from spec_schema.diagnostics import SpecError
from spec_schema.load import examine


def compile_file(
    path: Path, progress: Progress, judge: Judge | None = None, *, allow_code: bool = False
) -> Compiled:
    """Compile the behavior spec at `path`; see `compile_loaded`.

    Raises:
        SpecError: with everything that is wrong with it.
    """
    examined = examine(path)
    if examined.mistakes or examined.loaded is None:
        raise SpecError(check_examined(examined))
    return compile_loaded(examined.loaded, progress, judge, allow_code=allow_code)
