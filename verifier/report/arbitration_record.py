"""How a robot's arbiter decides, as JSON values. Quantities stand in the unit that is named."""

import math

from verifier.report.arbitration import Arbitration, Region, Share, Threshold


def arbitration_record(of: Arbitration) -> dict[str, object]:
    """The section as docs/json_report.md has it."""
    return {
        "agreement": _share(of.share),
        "required": of.required,
        "choices": list(of.choices),
        "confusion": of.confusion.tolist(),
        "cells": [_region(each) for each in of.cells],
        "boxes": [_region(each) for each in of.boxes],
        "thresholds": [_threshold(each) for each in of.thresholds],
        "delay": of.delay * of.period,
        "explanations": [
            {"label": each.label, "agreeing": each.agreeing} for each in of.explanations
        ],
        "unexplained": of.unexplained,
        "strays": [
            {
                "start": each.start,
                "end": each.end,
                "decisions": each.decisions,
                "robot": each.robot,
                "spec": each.spec,
            }
            for each in of.strays
        ],
        "sentences": list(of.sentences),
        "origin": of.origin,
    }


def _share(share: Share) -> dict[str, object]:
    return {
        "share": share.value,
        "agreeing": share.agreeing,
        "decisions": share.decisions,
        "effective": share.effective,
        "interval": [share.interval.low, share.interval.high],
    }


def _region(region: Region) -> dict[str, object]:
    where = {"conditions": list(region.conditions), "standing": str(region.standing)}
    return where | _share(region.share)


def _threshold(each: Threshold) -> dict[str, object]:
    scale = each.unit.scale
    ends = (each.interval.low, each.interval.high)
    return {
        "name": each.name,
        "comparison": each.comparison,
        "unit": each.unit.text,
        "spec": each.value / scale,
        "fitted": each.fitted / scale,
        "interval": [end / scale if math.isfinite(end) else None for end in ends],
        "agreeing": each.agreeing,
        "standing": str(each.standing),
        "origin": each.origin,
    }
