"""specc: a declarative spec compiler and verifier for robot behaviors.

`import specc` is cheap; what a name stands for is loaded when it is first used.
"""

TYPE_CHECKING = False  # `typing` would be the first thing that a command waits for
if TYPE_CHECKING:
    from compiler.check import check as check
    from compiler.compile import Compiled as Compiled
    from compiler.dump import dump as dump
    from lcs.alcsr.learner import ALCSR as ALCSR
    from lcs.estimator import ALCSRClassifier as ALCSRClassifier
    from lcs.inputs import Input as Input
    from runtime.program import Program as Program
    from runtime.rollout import Rollout as Rollout
    from spec_schema.diagnostics import Diagnostic as Diagnostic
    from spec_schema.diagnostics import SpecError as SpecError
    from specc.book.export import export_book as export_book
    from specc.book.loading import LoadedBook as LoadedBook
    from specc.book.loading import load_book as load_book
    from specc.claiming import check_claims as check_claims
    from specc.comparing import compare_behaviors as compare_behaviors
    from specc.drawn import draw as draw
    from specc.fitting.fit import fit as fit
    from specc.fitting.fitted import Fitted as Fitted
    from specc.loading import compile_spec as compile_spec
    from specc.loading import load_program as load_program
    from specc.loading import write_artifact as write_artifact
    from specc.portraying import Sweep as Sweep
    from specc.portraying import branches as branches
    from specc.portraying import portrait as portrait
    from specc.portraying import sweep as sweep
    from specc.recorded import record as record
    from specc.recorded import record_run as record_run
    from specc.reported import write_report as write_report
    from specc.reported import write_reports as write_reports
    from specc.running import simulate as simulate
    from specc.scenarios.pictures import draw_run as draw_run
    from specc.scenarios.pictures import film_run as film_run
    from specc.scenarios.simulating import Simulation as Simulation
    from specc.scenarios.simulating import simulate_scenario as simulate_scenario
    from specc.verifying.book_verdict import verify_book as verify_book
    from specc.verifying.recording import RunVerification as RunVerification
    from specc.verifying.recording import verify_run as verify_run
    from specc.verifying.runs import Runs as Runs
    from specc.verifying.runs import verify_each as verify_each
    from specc.verifying.runs import verify_together as verify_together
    from specc.verifying.trace import Verification as Verification
    from specc.verifying.trace import verify as verify
    from verifier.report.report import Report as Report
    from verifier.report.report import Verdict as Verdict
    from verifier.topology.branches.continuation import Branches as Branches
    from verifier.topology.claims.findings import Finding as Finding
    from verifier.topology.comparing.comparison import Comparison as Comparison
    from verifier.topology.features import Portrait as Portrait

__version__ = "0.1.0"

HOMES = {
    "ALCSR": "lcs.alcsr.learner",
    "ALCSRClassifier": "lcs.estimator",
    "Input": "lcs.inputs",
    "Compiled": "compiler.compile",
    "Program": "runtime.program",
    "Rollout": "runtime.rollout",
    "Diagnostic": "spec_schema.diagnostics",
    "SpecError": "spec_schema.diagnostics",
    "Verification": "specc.verifying.trace",
    "check": "compiler.check",
    "export_book": "specc.book.export",
    "load_book": "specc.book.loading",
    "LoadedBook": "specc.book.loading",
    "check_claims": "specc.claiming",
    "compare_behaviors": "specc.comparing",
    "compile_spec": "specc.loading",
    "dump": "compiler.dump",
    "load_program": "specc.loading",
    "branches": "specc.portraying",
    "portrait": "specc.portraying",
    "sweep": "specc.portraying",
    "simulate": "specc.running",
    "Simulation": "specc.scenarios.simulating",
    "simulate_scenario": "specc.scenarios.simulating",
    "record_run": "specc.recorded",
    "draw_run": "specc.scenarios.pictures",
    "film_run": "specc.scenarios.pictures",
    "verify": "specc.verifying.trace",
    "verify_book": "specc.verifying.book_verdict",
    "verify_run": "specc.verifying.recording",
    "RunVerification": "specc.verifying.recording",
    "fit": "specc.fitting.fit",
    "Fitted": "specc.fitting.fitted",
    "write_artifact": "specc.loading",
    "draw": "specc.drawn",
    "record": "specc.recorded",
    "write_report": "specc.reported",
    "write_reports": "specc.reported",
    "verify_each": "specc.verifying.runs",
    "verify_together": "specc.verifying.runs",
    "Runs": "specc.verifying.runs",
    "Report": "verifier.report.report",
    "Verdict": "verifier.report.report",
    "Comparison": "verifier.topology.comparing.comparison",
    "Branches": "verifier.topology.branches.continuation",
    "Portrait": "verifier.topology.features",
    "Sweep": "specc.portraying",
    "Finding": "verifier.topology.claims.findings",
}
"""Where each public name is at home."""

EXTRAS = {"sklearn": "scikit-learn"}
"""What an extra of the same name installs."""

__all__ = [*HOMES]  # noqa: PLE0604  the names are text


def __dir__() -> list[str]:
    return [*HOMES, "__version__"]


def __getattr__(name: str) -> object:
    """Load a public name from its home, once."""
    if name not in HOMES:
        raise AttributeError(f"module 'specc' has no attribute '{name}'")
    import importlib  # noqa: PLC0415  only when something is used

    try:
        home = importlib.import_module(HOMES[name])
    except ModuleNotFoundError as error:
        extra = (error.name or "").partition(".")[0]
        if extra not in EXTRAS:
            raise
        raise ImportError(
            f"specc.{name} needs {EXTRAS[extra]}: pip install 'specc[{extra}]'"
        ) from error
    value: object = getattr(home, name)
    globals()[name] = value
    return value
