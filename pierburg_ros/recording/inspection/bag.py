"""The topics of a bag."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.recording.clocks import is_headed
from pierburg_ros.recording.formats import cdr
from pierburg_ros.recording.formats.messages import Bag, Messages
from pierburg_ros.recording.inspection.content import FieldContent, Guesses, TopicContent, contents_of, rate
from pierburg_ros.recording.inspection.fields import Field, fields_of
from pierburg_ros.recording.inspection.guesses import guess
from pierburg_ros.recording.inspection.likeness import likened
from pierburg_ros.recording.loss import are_numbered, numbered_loss, pauses
from pierburg_ros.recording.signal_map import SignalMap
from pierburg_ros.recording.signals import SIGNALS, last_name


def topics(bag: Bag, chosen: SignalMap) -> tuple[tuple[TopicContent, ...], Guesses]:
    """The topics of a file or folder, and what each of their numbers could be."""
    found = {topic: bag.messages(topic) for topic in sorted(bag.types)}
    fields = {topic: fields_of(messages) for topic, messages in found.items()}
    guessed = {field: guess(field) for several in fields.values() for field in several}
    guessed |= likened(guessed)
    first = min((int(each.log_time[0]) for each in found.values() if len(each)), default=0)
    contents = tuple(
        topic_content(each, first, used_as(each, chosen), contents_of(fields[topic], guessed), fields[topic])
        for topic, each in found.items()
    )
    return contents, guessed


def topic_content(
    found: Messages, first: int, read_as: str | None, contents: tuple[FieldContent, ...], fields: Sequence[Field]
) -> TopicContent:
    """What the messages of one topic are; times count from `first` [ns]."""
    time: Signal = (found.log_time - first).astype(np.float64) * 1e-9
    lost = numbered_loss(found.topic, time, found.sequence) if are_numbered(found.sequence) else None
    only = fields[0].limits if len(fields) == 1 else None
    return TopicContent(
        found.topic,
        found.type,
        len(found),
        rate(time),
        only[0] if only else None,
        only[1] if only else None,
        None if lost is None else lost.lost,
        pauses(time) if lost is None else lost.spans,
        clocks(found),
        read_as,
        contents,
    )


def used_as(found: Messages, chosen: SignalMap) -> str | None:
    """The signals that a topic is read as: as a person chose, or by its own name and type."""
    signals = [signal for signal, source in chosen.sources.items() if source.name == found.topic]
    name = last_name(found.topic)
    usual = [signal for signal, each in SIGNALS.items() if each.topics.get(name) == found.type]
    free = [signal for signal in usual if signal not in chosen.sources and signal not in chosen.left_out]
    clock = ["clock"] if (name, found.type) == ("clock", cdr.CLOCK) else []
    return ", ".join([*signals, *free, *clock]) or None


def clocks(found: Messages) -> tuple[str, ...]:
    """The clocks that the messages themselves carry."""
    has = {
        "stamp": is_headed(found) and all(found.data) and bool(np.any(cdr.stamp(found))),
        "publish": bool(np.any(found.publish_time)),
        "log": bool(np.any(found.log_time)),
    }
    return tuple(name for name, is_there in has.items() if is_there)
