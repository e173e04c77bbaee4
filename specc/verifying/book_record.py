"""Where the modules of a book stand, as JSON values, in the format of docs/json_report.md."""

from specc.verifying.book_modules import WORST_FIRST, BookVerdict, ModuleVerdict
from verifier.report.examination_record import FORMAT, examination_record


def book_record(verdict: BookVerdict) -> dict[str, object]:
    """The standing of the whole, the counts, and each module in the order of the book."""
    return {
        "format": FORMAT,
        "book": verdict.name,
        "standing": str(verdict.standing),
        "counts": {str(each): verdict.count(each) for each in WORST_FIRST}
        | {"unusable": len(verdict.unusable), "left out": verdict.left_out},
        "modules": [_module(each) for each in verdict.modules],
        "unusable": [
            {
                "trace": {"source": each.source},
                "diagnostics": [problem.as_json() for problem in each.error.diagnostics],
            }
            for each in verdict.unusable
        ],
    }


def _module(each: ModuleVerdict) -> dict[str, object]:
    piece = each.piece
    return {
        "architecture": piece.place.architecture,
        "node": piece.place.node,
        "kind": piece.kind,
        "spec": None if piece.spec is None else piece.spec.name,
        "standing": str(each.standing),
        "page": each.page,
        "why": list(each.why),
        "to_record": list(each.to_record),
        "recordings": [
            {
                "source": one.report.trace.source,
                "verdict": str(one.report.verdict),
                "found_by": one.found.how,
            }
            for one in each.members
        ],
        "not_judged": [{"source": one.source, "why": one.why} for one in each.not_judged],
        "together": None if each.together is None else examination_record(each.together),
    }
