"""An edited text as a program, or why it can't be one."""

from compiler.compile import compile_loaded
from runtime.program import Program
from runtime.progress import in_silence
from spec_schema.diagnostics import SpecError
from spec_schema.load import Loaded, load_source
from spec_schema.source import Source
from specc.faults import fault
from specc.sketch_judge import faults_of


def compiled(source: Source) -> tuple[Loaded, Program]:
    """The edited text, loaded and compiled.

    Raises:
        SpecError: it is no spec any more (V373), say since a value left its domain.
    """
    try:
        loaded = load_source(source)
        return loaded, compile_loaded(loaded, in_silence, faults_of).program
    except SpecError as error:
        first = error.diagnostics[0]
        message = f"with the robot's numbers the spec can't be compiled: {first.message}"
        remedy = f"at {first.path}: {first.help}" if first.help else f"look at {first.path}"
        raise fault("V373", source.name, message, f"{remedy}; nothing was written") from error
