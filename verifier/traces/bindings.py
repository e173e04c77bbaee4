"""Which topic or column each variable of a program is read from."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import final

from runtime.program import Binding, Program
from runtime.recording.behavior import own_bindings
from spec_schema.diagnostics import Diagnostic, Severity, SpecError
from spec_schema.source import Source
from verifier.traces.faults import binding_diagnostic, nearest_help, origin_span
from verifier.traces.files.log import LogFile, MessageLog, Sheet, Wanted
from verifier.traces.messages.paths import (
    MessagePath,
    PathError,
    column_text,
    parse_column,
    parse_path,
)
from verifier.traces.other_kind import of_other_kind, other_kind_diagnostic


@final
@dataclass(frozen=True, slots=True)
class Bound:
    """A binding and the place in the log that it names.

    topic: of a message log, or the file's name of a sheet. column: the key of its values in
    `Samples`. derived: whether the values are angles of a quaternion.
    """

    binding: Binding
    topic: str
    column: str
    path: MessagePath | None

    @property
    def derived(self) -> bool:
        """Whether the values are angles of a quaternion."""
        return self.path is not None and self.path.derived != ""


def wanted_by(program: Program) -> Wanted:
    """What the program's bindings name in a log, in its own recordings too."""
    wanted: dict[str, dict[str, MessagePath]] = {}
    bindings = (*program.bindings, *_own_bindings(program))
    for binding in bindings:
        with suppress(PathError):
            path = parse_path(binding.path)
            wanted.setdefault(path.topic, {})[path.text] = path
    columns = {parse_column(binding.path) for binding in bindings if binding.path}
    columns |= {binding.name for binding in bindings}
    by_topic = {topic: tuple(paths.values()) for topic, paths in wanted.items()}
    return Wanted(by_topic, frozenset(columns))


def resolve(program: Program, log: LogFile) -> tuple[Bound, ...]:
    """Where each variable stands in this log; raises SpecError V303, V308 and V310.

    A control that is neither bound nor recorded by specc itself is left out.
    """
    found: list[Bound] = []
    strangers = of_other_kind(program, log)
    problems = [other_kind_diagnostic(program, log, strangers)] if strangers else []
    for binding in program.bindings:
        if binding.constant is None and binding not in strangers:
            bound = _bind(program, log, binding)
            problems.append(bound) if isinstance(bound, Diagnostic) else found.append(bound)
    for binding in _own_bindings(program):
        if isinstance(log, MessageLog) and _topic(binding.path) in log.topics:
            path = parse_path(binding.path)
            found.append(Bound(binding, path.topic, path.text, path))
        elif isinstance(log, Sheet) and binding.name in log.columns:
            own = replace(binding, path=column_text(binding.name))
            found.append(Bound(own, log.name, binding.name, None))
    problems += _unbound(program, log, {bound.binding.name for bound in found})
    if problems:
        raise SpecError(problems)
    return tuple(found)


def texts_of(values: tuple[str, ...]) -> tuple[tuple[str, int], ...]:
    """Each value's own name as the text that stands for its index."""
    return tuple((text, index) for index, text in enumerate(values))


def _own_bindings(program: Program) -> tuple[Binding, ...]:
    """Bindings to what specc records itself, for the variables that are not bound otherwise."""
    bound = {binding.name for binding in program.bindings}
    return tuple(binding for binding in own_bindings(program) if binding.name not in bound)


def _topic(path: str) -> str:
    try:
        return parse_path(path).topic
    except PathError:
        return ""


def _bind(program: Program, log: LogFile, binding: Binding) -> Bound | Diagnostic:
    if isinstance(log, Sheet):
        return _bind_column(program, log, binding)
    try:
        path = parse_path(binding.path)
    except PathError as error:
        part = (error.start, error.end)
        return binding_diagnostic(
            program, binding, "V308", error.message, help=error.help, part=part
        )
    if path.topic not in log.topics:
        message = f"the log has no topic '{path.topic}'"
        return binding_diagnostic(
            program,
            binding,
            "V303",
            message,
            help=nearest_help(path.topic, log.topics, "topics"),
            part=(0, len(path.topic)),
        )
    return Bound(binding, path.topic, path.text, path)


def _bind_column(program: Program, sheet: Sheet, binding: Binding) -> Bound | Diagnostic:
    name = parse_column(binding.path)
    if name in sheet.columns:
        return Bound(binding, sheet.name, name, None)
    message = f"the file has no column '{name}'"
    help_text = nearest_help(name, tuple(sheet.columns), "columns")
    return binding_diagnostic(program, binding, "V303", message, help=help_text)


def _unbound(program: Program, log: LogFile, found: set[str]) -> list[Diagnostic]:
    named = found | {binding.name for binding in program.bindings}
    source = Source(program.source.file, program.source.text)
    return [
        Diagnostic(
            "V310",
            Severity.ERROR,
            f"nothing in the log is bound to the driven state '{state.name}'",
            source,
            origin_span(source, state.origin),
            path=f"$.state.{state.name}",
            help=_binding_help(state.name, log),
        )
        for state in program.states
        if state.is_driven and state.name not in named
    ]


def _binding_help(name: str, log: LogFile) -> str:
    if isinstance(log, Sheet):
        return f"write trace: {{{name}: COLUMN}}\n{_listed('columns', tuple(log.columns))}"
    return f"write trace: {{{name}: /TOPIC.FIELD}}\n{_listed('topics', log.topics)}"


def _listed(noun: str, names: Sequence[str]) -> str:
    return nearest_help("", names, noun)
