"""specc: a declarative spec compiler and verifier for robot behaviors.

`import specc` is cheap; what a name stands for is loaded when it is first used.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from compiler.compile import Compiled as Compiled
    from runtime.program import Program as Program
    from runtime.rollout import Rollout as Rollout
    from spec_schema.diagnostics import Diagnostic as Diagnostic
    from spec_schema.diagnostics import SpecError as SpecError
    from specc.api import Verification as Verification
    from specc.api import check as check
    from specc.api import compile_spec as compile_spec
    from specc.api import dump as dump
    from specc.api import load_program as load_program
    from specc.api import portrait as portrait
    from specc.api import simulate as simulate
    from specc.api import verify as verify
    from specc.api import write_artifact as write_artifact
    from specc.outputs import draw as draw
    from specc.outputs import record as record
    from specc.outputs import write_report as write_report
    from verifier.report.report import Report as Report
    from verifier.report.report import Verdict as Verdict
    from verifier.topology.features import Portrait as Portrait

__version__ = "0.1.0"

HOMES = {
    "Compiled": "compiler.compile",
    "Program": "runtime.program",
    "Rollout": "runtime.rollout",
    "Diagnostic": "spec_schema.diagnostics",
    "SpecError": "spec_schema.diagnostics",
    "Verification": "specc.api",
    "check": "specc.api",
    "compile_spec": "specc.api",
    "dump": "specc.api",
    "load_program": "specc.api",
    "portrait": "specc.api",
    "simulate": "specc.api",
    "verify": "specc.api",
    "write_artifact": "specc.api",
    "draw": "specc.outputs",
    "record": "specc.outputs",
    "write_report": "specc.outputs",
    "Report": "verifier.report.report",
    "Verdict": "verifier.report.report",
    "Portrait": "verifier.topology.features",
}
"""Where each public name is at home."""

__all__ = [*HOMES]  # noqa: PLE0604  the names are text


def __getattr__(name: str) -> object:
    """Load a public name from its home, once."""
    if name not in HOMES:
        raise AttributeError(f"module 'specc' has no attribute '{name}'")
    import importlib  # noqa: PLC0415  only when something is used

    value: object = getattr(importlib.import_module(HOMES[name]), name)
    globals()[name] = value
    return value
