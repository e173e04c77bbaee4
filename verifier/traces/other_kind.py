"""A spec made for the other kind of log: columns where there are topics, or the reverse."""

from collections.abc import Sequence

from runtime.program import Binding, Program
from spec_schema.diagnostics import Diagnostic
from verifier.traces.alike import alike
from verifier.traces.faults import binding_diagnostic, nearest_help
from verifier.traces.files.log import LogFile, Messages, Sheet
from verifier.traces.messages.codecs import find_codec
from verifier.traces.messages.fields import FieldError
from verifier.traces.messages.leaves import all_paths
from verifier.traces.messages.paths import parse_column

MOST_NAMED = 4


def of_other_kind(program: Program, log: LogFile) -> tuple[Binding, ...]:
    """The bindings that can't be meant for a log of this kind."""
    bound = [binding for binding in program.bindings if binding.constant is None]
    if isinstance(log, Sheet):
        return tuple(b for b in bound if _is_path(b.path) and b.path not in log.columns)
    # Topics without a slash are those of ULog and of a few other recorders.
    rooted = all(topic.startswith("/") for topic in log.topics)
    return tuple(b for b in bound if _is_column(b.path, log.topics, rooted=rooted))


def other_kind_diagnostic(
    program: Program, log: LogFile, strangers: Sequence[Binding]
) -> Diagnostic:
    """One for all of them, at the first, with what to write instead."""
    names = [f"'{parse_column(binding.path)}'" for binding in strangers]
    more = len(names) - MOST_NAMED
    named = ", ".join(names[:MOST_NAMED]) + (f" and {more} more" if more > 0 else "")
    one = len(names) == 1
    if isinstance(log, Sheet):
        what = "is a path to a field of a topic" if one else "are paths to fields of topics"
        message = f"the log is a CSV file, which has columns and no topics; {named} {what}"
        known, noun, blank = tuple(log.columns), "columns", "COLUMN"
        candidates = known
    else:
        what = "is the name of a column" if one else "are names of columns"
        message = f"the log ({log.kind}) has topics and no columns; {named} {what}, as in a CSV"
        known, noun, blank = log.topics, "topics", "/TOPIC.FIELD"
        candidates = _by_likeness(strangers, [_paths(stream) for stream in log.streams])
    lines = [f"  {binding.name}: {_alike(binding, candidates) or blank}" for binding in strangers]
    help_text = "\n".join(
        ("what looks alike in this log:", "trace:", *lines, nearest_help("", known, noun))
    )
    return binding_diagnostic(program, strangers[0], "V303", message, help=help_text)


def _alike(binding: Binding, candidates: Sequence[str]) -> str:
    return alike(parse_column(binding.path), candidates) or alike(binding.name, candidates)


def _by_likeness(
    strangers: Sequence[Binding], streams: Sequence[tuple[str, ...]]
) -> tuple[str, ...]:
    """All paths, those of the topics first that have something like most of the variables."""

    def likeness(paths: tuple[str, ...]) -> int:
        return sum(bool(_alike(binding, paths)) for binding in strangers)

    return tuple(path for paths in sorted(streams, key=likeness, reverse=True) for path in paths)


def _is_path(text: str) -> bool:
    return parse_column(text).startswith("/") and "." in text


def _is_column(text: str, topics: Sequence[str], *, rooted: bool) -> bool:
    name = parse_column(text)
    if name.startswith("/") or any(name.startswith(topic) for topic in topics):
        return False
    return rooted or "." not in name


def _paths(stream: Messages) -> tuple[str, ...]:
    """All that a stream's messages hold by their definition; nothing where there is none."""
    try:
        root = find_codec(stream.channel, ()).root
    except FieldError:
        return ()
    return tuple(path.text for path in all_paths(root, stream.channel.topic))
