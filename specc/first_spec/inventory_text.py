"""What a log holds, as a table for people."""

from collections.abc import Iterator

from verifier.traces.inventory import FieldInfo, Inventory

MOST_FIELDS = 40  # listed per topic


def describe(found: Inventory) -> str:
    """Topics, types, rates and fields, as a table for people."""
    return "\n".join(_description(found))


def _description(found: Inventory) -> Iterator[str]:
    yield f"{found.source}: {found.kind}, {found.duration:.1f} s, {found.messages:,} messages"
    for topic in found.topics:
        name = topic.name or "columns"
        yield ""
        yield f"{name}  {topic.message_type}  {topic.count:,} messages, {topic.rate:.3g} Hz"
        for info in topic.fields[:MOST_FIELDS]:
            yield f"    {info.path:58} {looks(info)}"
        if len(topic.fields) > MOST_FIELDS:
            yield f"    and {len(topic.fields) - MOST_FIELDS} more fields"
        if topic.note:
            yield f"    ({topic.note})"
    for loss in found.losses:
        yield f"lost: {loss.cause} ({loss.count}) {loss.detail}"
    for note in found.notes:
        yield f"note: {note}"


def looks(info: FieldInfo) -> str:
    """The range of a number, or the texts of a text."""
    if info.is_text:
        return ", ".join(info.texts[:6])
    if info.low is None or info.high is None:
        return "no finite number"
    return f"{info.low:.4g}" if info.low == info.high else f"{info.low:.4g} to {info.high:.4g}"
