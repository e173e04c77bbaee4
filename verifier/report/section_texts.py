"""The sections of an examination as plain text: their sentences, and short tables beside them."""

from runtime.program import Unit
from verifier.report.arbitration_text import arbitration_text
from verifier.report.diagnosis import Candidate, Diagnosis, FittedNumber
from verifier.report.examination import Examination
from verifier.report.features import FeatureNumber, Features
from verifier.report.layout import INDENT, bullets, section, table
from verifier.report.limits import Limits
from verifier.report.requirement_record import requirements_text
from verifier.report.scores import Scores, VariableScores
from verifier.report.switching import Switching
from verifier.report.why import untaken, why
from verifier.report.wording import digits_of, number, percent, quantity, shown, span

MOST_CANDIDATES = 5


def section_texts(examination: Examination) -> tuple[str, ...]:
    """The sections that were computed and have something to say, in the order of reading."""
    of = examination
    texts = (
        requirements_text(of.requirements) if of.requirements else "",
        "" if of.arbitration is None else arbitration_text(of.arbitration),
        "" if of.diagnosis is None else _diagnosis(of.diagnosis, of.switching),
        "" if of.switching is None else _switching(of.switching),
        "" if of.features is None else _features(of.features),
        "" if of.limits is None else _limits(of.limits),
        "" if of.scores is None else _scores(of.scores),
    )
    return tuple(text for text in texts if text)


def _diagnosis(diagnosis: Diagnosis, switching: Switching | None) -> str:
    others = untaken(diagnosis)[:MOST_CANDIDATES]
    rows = [
        (
            each.label,
            ", ".join(_number(n) for n in each.numbers),
            _worth(each),
        )
        for each in others
    ]
    title, sentences = why(diagnosis, switching)
    blocks = [bullets(sentences)]
    if rows:
        title_of = "tried instead of the first (shares of the error beyond noise):"
        blocks.append(f"{INDENT}{title_of}\n{table(rows, INDENT)}")
    return section(f"why: {title}", blocks)


def _worth(candidate: Candidate) -> str:
    """How much it explains, and what it would leave."""
    share = percent(max(candidate.evidence.share, 0.0))
    left = f", leaves {candidate.leaves}" if candidate.leaves else ""
    return f"explains {share}{left}"


def _number(each: FittedNumber) -> str:
    """A delay without its sign: the label says late or early."""
    value = abs(each.value) if each.name == "delay" else each.value
    return f"{each.name} {quantity(value, each.unit)}"


def _switching(switching: Switching) -> str:
    rows = [
        (
            f"{way.source} to {way.target}",
            str(way.expected),
            str(way.unexpected),
            str(way.missed),
            str(way.wrong),
            "-" if way.timing is None else f"{number(way.timing.late)} s",
            "-" if way.timing is None else f"{number(way.timing.allowed)} s",
            str(way.standing),
        )
        for way in switching.ways
    ]
    header = ("", "expected", "unexpected", "missed", "elsewhere", "late", "allowed", "")
    blocks = [bullets(switching.reasons), table([header, *rows], INDENT) if rows else ""]
    return section(f"changes of {switching.mode}: {switching.standing}", blocks)


def _features(features: Features) -> str:
    rows = [
        (
            feature.name,
            each.name,
            each.unit.text,
            "-" if each.spec != each.spec else shown(each.spec, each.unit),
            _robot(each),
            str(each.standing),
        )
        for feature in features.features
        for each in feature.numbers
    ]
    header = ("", "", "unit", "spec", "robot", "")
    sentences = [feature.sentence for feature in features.features]
    blocks = [bullets(sentences), table([header, *rows], INDENT) if rows else ""]
    return section("features of the field", [*blocks, bullets(features.notes)])


def _robot(each: FeatureNumber) -> str:
    if each.robot is None:
        return "-"
    interval = each.robot.interval
    ends = (interval.low / each.unit.scale, interval.high / each.unit.scale)
    value = number(each.robot.value / each.unit.scale, digits_of(*ends))
    return f"{value} ({span(interval.low, interval.high, Unit('', each.unit.scale))})"


def _limits(limits: Limits) -> str:
    untold = [f"{each.what}: {each.why}; {each.suggestion}" for each in limits.not_told]
    caught = [each.sentence for each in limits.caught]
    told = section("what this trace can't tell", [bullets(untold)])
    test = section("what would have been caught", [bullets([*caught, *limits.notes])])
    return "\n\n".join(text for text in (told, test) if text)


def _scores(scores: Scores) -> str:
    header = ("", "ISO 18571", "corridor", "phase", "magnitude", "slope", "NRMSE", "R²")
    rows = [_score_row(each) for each in scores.variables]
    blocks = [bullets(scores.sentences), table([header, *rows], INDENT)]
    return section("scores, for comparison only", blocks)


def _score_row(each: VariableScores) -> tuple[str, ...]:
    iso = each.iso
    parts = (
        ("-",) * 5
        if iso is None
        else tuple(
            f"{part:.3f}"
            for part in (iso.overall, iso.corridor, iso.phase, iso.magnitude, iso.slope)
        )
    )
    return (each.name, *parts, number(each.nrmse), f"{each.r_squared:.3f}")
