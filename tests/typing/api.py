"""The public API as a user writes it; mypy checks this file, nobody runs it."""

from pathlib import Path

import specc


def judge(trace: Path) -> bool:
    verification: specc.Verification = specc.verify(trace)
    report: specc.Report = verification.report
    specc.write_report(verification, Path("report.html"))
    return report.verdict is specc.Verdict.PASS


def explore(path: Path) -> list[float]:
    problems: tuple[specc.Diagnostic, ...] = specc.check(path)
    if problems:
        raise specc.SpecError(problems)
    program: specc.Program = specc.load_program(path)
    rollout: specc.Rollout = specc.simulate(program, {"x": 1.0}, "20 s", {"mu": "1.5"})
    portrait: specc.Portrait = specc.portrait(program, ["x", "v"], {"mu": 2.0})
    again: specc.Portrait = specc.portrait(path, held={"mu": 1.0})
    sweep: specc.Sweep = specc.sweep(path, "mu", [0.5, "1.0"])
    assert sweep.portraits[0].name == again.name
    branches: specc.Branches = specc.branches(path, "mu", "0.5:1")
    assert not branches.bifurcations
    comparison: specc.Comparison = specc.compare_behaviors(path, program)
    assert comparison.adheres
    specc.draw(portrait, Path("portrait.svg"))
    specc.record(program, rollout, Path("run.mcap"))
    times: list[float] = rollout.times.tolist()
    return times


def build(path: Path) -> bytes:
    compiled: specc.Compiled = specc.compile_spec(path)
    text: str = specc.dump(compiled.program)
    assert text
    return specc.write_artifact(compiled.program, "x.specc")
