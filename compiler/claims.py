"""Claims of `expect:` in the program's terms: sentences understood, names found, values in SI."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from compiler.claim_text import claim_text
from compiler.claim_values import ClaimReader
from compiler.declare import Declarations
from compiler.findings import Findings
from runtime.claim import Claim
from spec_schema.behavior import BehaviorSpec
from spec_schema.claim_sentences import BASIN, CYCLES, Sentence, SentenceError, read_sentence
from spec_schema.expect import ClaimOptions, ClaimSpec
from spec_schema.load import Loaded
from spec_schema.places import Path
from spec_schema.suggest import did_you_mean
from spec_schema.wording import with_article

REPELS: Final = frozenset(
    {
        *("unstable fixed point", "unstable node", "unstable focus", "saddle", "center"),
        *("repeller", "unstable cycle", "semi-stable cycle", "saddle cycle"),
    }
)
"""What nothing goes to, but from a part of the domain without area."""

PERIOD_WITHIN: Final = 0.01
"""The share that a period may be off where the claim does not say."""


def lower_claims(
    spec: BehaviorSpec, declared: Declarations, loaded: Loaded, findings: Findings
) -> tuple[Claim, ...]:
    """The claims that can be used, and a finding for each mistake in one."""
    claims: list[Claim] = []
    for index, claim in enumerate(spec.expect):
        sentence = _sentence(claim, ("expect", index), findings)
        if sentence is not None:
            path: Path = ("expect", index, claim.sentence)
            _check_options(sentence, claim.options, path, findings)
            _check_references(sentence, claim.options, claims, path, findings)
            reader = ClaimReader(spec, declared, findings, path)
            origin = loaded.origin(("expect", index))
            text = claim_text(claim, declared.units)
            claims.append(_claim(sentence, claim, reader, text, origin))
    return tuple(claims)


def names_read(claims: Iterable[Claim]) -> frozenset[str]:
    """Every token of the claims' code: the names that they read are among them."""
    codes = [code for claim in claims for code in _codes(claim)]
    return frozenset(token for text in codes for token in text.split(" "))


def _codes(claim: Claim) -> Iterator[str]:
    for place in claim.places:
        yield place.at.text
    for reach in claim.reaches:
        yield reach.low.text
        yield reach.high.text
    if claim.period is not None:
        yield claim.period.text


def _sentence(claim: ClaimSpec, path: Path, findings: Findings) -> Sentence | None:
    try:
        return read_sentence(claim.sentence)
    except SentenceError as error:
        findings.fault((*path, claim.sentence), error.fault, key=True)
        return None


def _claim(
    sentence: Sentence, claim: ClaimSpec, reader: ClaimReader, text: str, origin: str
) -> Claim:
    options = claim.options
    period = reader.period(options)
    return Claim(
        text=text,
        feature=sentence.feature,
        least=sentence.least,
        most=sentence.most,
        other=sentence.other,
        places=reader.places(options),
        reaches=reader.reaches(options),
        period=period,
        period_within=reader.period_within(options, PERIOD_WITHIN),
        share=sentence.share,
        goes_to=sentence.goes_to,
        called=options.called or "",
        over=reader.over(options),
        settings=reader.settings(options),
        sketched=False,
        origin=origin,
    )


def _check_options(
    sentence: Sentence, options: ClaimOptions, path: Path, findings: Findings
) -> None:
    """A finding for each condition that says nothing about what is counted."""
    for key, why in _misfits(sentence, options).items():
        findings.error("S273", (*path, key), why, f"remove '{key}'", key=True)
    if options.within is not None and not (options.at or options.reaches or options.period):
        message = "'within' says how far 'at', 'reaches' or 'period' may be off; none is given"
        findings.error("S273", (*path, "within"), message, "remove 'within'", key=True)


def _misfits(sentence: Sentence, options: ClaimOptions) -> Mapping[str, str]:
    found = {}
    if sentence.feature == BASIN:
        keys = ("at", "reaches", "period", "within", "called")
        why = "a claim on a share of the domain counts nothing: it only has 'over' and 'where'"
        found = {key: why for key in keys if getattr(options, key)}
    elif sentence.feature in CYCLES and options.at:
        found["at"] = "a cycle is not at one place: say how far it swings with 'reaches'"
    elif sentence.feature not in CYCLES:
        for key in ("reaches", "period"):
            if getattr(options, key):
                found[key] = f"'{key}' is for cycles, and this claim is not about cycles alone"
    return found


def _check_references(
    sentence: Sentence, options: ClaimOptions, above: list[Claim], path: Path, findings: Findings
) -> None:
    """A finding for what refers to a claim above that does not exist, or does not fit."""
    counting = [claim for claim in above if claim.feature != BASIN]
    names = [claim.called for claim in counting if claim.called]
    if options.called in names:
        message = f"'{options.called}' is the name of something else above"
        findings.error("S274", (*path, "called"), message, "take another name")
    if sentence.other and not counting:
        message = "other than what? no claim stands above this one"
        findings.error("S274", path, message, "leave 'other' out, or move the claim down", key=True)
    if sentence.feature != BASIN:
        return
    meant = [claim for claim in counting if sentence.goes_to in {"", claim.called}]
    if not meant:
        told = f"no claim above is called '{sentence.goes_to}'"
        message = told if sentence.goes_to else "'it' refers to the last claim above: there is none"
        remedy = did_you_mean(sentence.goes_to, names) or "name one with `called: home`"
        findings.error("S274", path, message, remedy, key=True)
    elif meant[-1].feature in REPELS:
        message = f"nothing goes to {with_article(meant[-1].feature)} but single trajectories"
        remedy = "write what attracts: a stable focus, a stable cycle, an attractor"
        findings.error("S274", path, message, remedy, key=True)
