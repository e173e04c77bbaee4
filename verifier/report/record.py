"""The report as JSON values, for other programs. Quantities stand in the unit that is named."""

import math

from runtime.program import Unit
from verifier.report.report import (
    Coverage,
    HorizonFigure,
    Interval,
    Noise,
    RegionMean,
    Report,
    Standing,
    VariableResult,
)


def as_json(report: Report) -> dict[str, object]:
    """What `json.dumps(..., allow_nan=False)` takes; an unbounded or absent number is null."""
    return {
        "verdict": str(report.verdict),
        "reasons": list(report.reasons),
        "advice": list(report.advice),
        "horizon": report.horizon,
        "confidence": report.confidence,
        "variables": {result.name: _variable(result, report) for result in report.variables},
        "coverage": None if report.coverage is None else _coverage(report.coverage),
        "exclusions": [
            {"cause": e.cause, "seconds": e.seconds, "samples": e.samples}
            for e in report.exclusions
        ],
        "losses": [
            {"cause": loss.cause, "count": loss.count, "detail": loss.detail}
            for loss in report.losses
        ],
        "notes": list(report.notes),
        "windows": len(report.starts),
        "spec": {
            "name": report.spec.name,
            "file": report.spec.file,
            "sha256": report.spec.sha256,
        },
        "trace": {
            "source": report.trace.source,
            "start": report.trace.start,
            "duration": report.trace.duration,
            "judged": report.trace.judged,
        },
    }


def _variable(result: VariableResult, report: Report) -> dict[str, object]:
    unit = result.unit
    worst = result.worst
    return {
        "unit": unit.text,
        "standing": str(result.standing),
        "tolerance": _number(result.tolerance, unit),
        "horizons": [_horizon(result, figure) for figure in result.horizons],
        "systematic": _number(result.systematic, unit),
        "scatter": _number(result.scatter, unit),
        "allowed_scatter": _number(result.allowed_scatter, unit),
        "unjudged": result.unjudged,
        "mean": _number(result.mean, unit),
        "mean_interval": _interval(result.mean_interval, unit),
        "noise": _noise(result.noise, unit),
        "worst": None if worst is None else _region(worst, unit, report),
        "regions": [_region(region, unit, report) for region in result.regions],
        "origin": result.origin,
    }


def _horizon(result: VariableResult, figure: HorizonFigure) -> dict[str, object]:
    is_declared = figure is result.declared
    unit = result.unit
    return {
        "horizon": figure.horizon,
        "windows": figure.windows,
        "rmse": _number(figure.rmse, unit),
        "noise": _number(figure.noise, unit),
        "departure": _number(figure.departure, unit),
        "interval": _interval(figure.interval, unit),
        "tolerance": _number(figure.tolerance, unit),
        "within": _within(result.standing if is_declared else figure.standing),
    }


def _within(standing: Standing) -> bool | None:
    """True, False, or null where the data does not decide."""
    return None if standing is Standing.UNDECIDED else standing is Standing.WITHIN


def _noise(noise: Noise, unit: Unit) -> dict[str, object]:
    return {
        "sigma": _number(noise.sigma, unit),
        "samples": noise.samples,
        "correlation": noise.correlation,
        "quantum": _number(noise.quantum, unit),
        "method": noise.method,
    }


def _region(region: RegionMean, unit: Unit, report: Report) -> dict[str, object]:
    return {
        "bounds": {
            name: {
                "low": _number(low, report.units[name]),
                "high": _number(high, report.units[name]),
                "unit": report.units[name].text,
            }
            for name, (low, high) in region.bounds.items()
        },
        "values": region.values,
        "moved": None if region.moved is None else _number(region.moved, unit),
        "hurried": None if region.hurried is None else _number(region.hurried, unit),
        "windows": region.windows,
        "mean": _number(region.mean, unit),
        "interval": _interval(region.interval, unit),
        "standing": str(region.standing),
    }


def _coverage(coverage: Coverage) -> dict[str, object]:
    return {
        "share": coverage.share,
        "required": coverage.required,
        "reached": coverage.is_reached,
        "enough": coverage.enough,
        "axes": [
            {
                "name": axis.name,
                "unit": axis.unit.text,
                "low": _number(axis.low, axis.unit),
                "high": _number(axis.high, axis.unit),
                "cells": axis.count,
                "values": list(axis.values),
            }
            for axis in coverage.axes
        ],
        "samples": coverage.samples.tolist(),
    }


def _interval(interval: Interval, unit: Unit) -> list[float | None]:
    return [_number(interval.low, unit), _number(interval.high, unit)]


def _number(value: float, unit: Unit) -> float | None:
    return value / unit.scale if math.isfinite(value) else None
