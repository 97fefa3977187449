"""Every message type: what is sent is what is received, in JSON and in MessagePack, and nothing else is let in."""

import math
import typing
from typing import Any

import msgspec
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from bench.fuzz.payloads import Payloads
from common import messages as m
from common import topics
from common.bus import codec
from common.bus.validation import LIMIT, bad_field
from common.topic import Topic

QUICK = settings(max_examples=15, deadline=None, suppress_health_check=list(HealthCheck))
KINDS = sorted({*(t.type for t in topics.TABLE), m.Health, m.LogRecord}, key=lambda k: k.__name__)
TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=40)
NUMBER = st.floats(-LIMIT / 100, LIMIT / 100)
PLAIN: dict[Any, st.SearchStrategy[Any]] = {
    float: NUMBER,
    int: st.integers(-(2**63), 2**63 - 1),
    str: TEXT,
    bool: st.booleans(),
    bytes: st.binary(max_size=200),
    object: st.one_of(TEXT, NUMBER, st.booleans(), st.none(), st.lists(TEXT, max_size=3)),
    type(None): st.none(),
}


def values(kind: Any, depth: int = 3) -> st.SearchStrategy[Any]:
    """Values of an annotated type."""
    origin, inner = typing.get_origin(kind), typing.get_args(kind)
    if kind in PLAIN:
        return PLAIN[kind]
    if origin is typing.Literal:
        return st.sampled_from(inner)
    if origin is tuple:
        return st.tuples(*(values(i, depth) for i in inner))
    if origin is list:
        return st.lists(values(inner[0], depth - 1), max_size=4) if depth > 0 else st.just([])
    if origin is dict:
        return st.dictionaries(TEXT, values(inner[1], depth - 1), max_size=3)
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        hints = typing.get_type_hints(kind)
        return st.builds(kind, **{name: values(hints[name], depth - 1) for name in kind.__struct_fields__})
    return st.one_of([values(i, depth - 1) for i in inner])


@pytest.mark.parametrize("kind", KINDS, ids=lambda k: k.__name__)
def test_a_message_comes_back_as_it_was(kind: type[m.Message]) -> None:
    @QUICK
    @given(values(kind))
    def there_and_back(message: m.Message) -> None:
        for payload in (msgspec.json.encode(message), msgspec.msgpack.encode(message)):
            assert codec.decode_as(kind, payload) == message

    there_and_back()


@pytest.mark.parametrize("topic", topics.TABLE, ids=lambda t: t.key)
def test_any_bytes_are_a_message_of_the_topic_or_refused(topic: Topic[Any]) -> None:
    @QUICK
    @given(st.one_of(st.binary(max_size=300), TEXT.map(str.encode), st.from_regex(rb'\A[\[{"].{0,40}\Z')))
    def receive(payload: bytes) -> None:
        try:
            message = codec.decode(topic, payload)
        except codec.DecodeError as error:
            assert str(error)
        else:
            assert type(message) is topic.type and not bad_field(message)

    receive()


@pytest.mark.parametrize("topic", topics.TABLE, ids=lambda t: t.key)
def test_hostile_payloads_of_every_kind_are_messages_or_refused(topic: Topic[Any]) -> None:
    make, refused = Payloads(7), 0
    for _ in range(300):
        try:
            message = codec.decode(topic, make.of(topic))
        except codec.DecodeError:
            refused += 1
        else:
            assert type(message) is topic.type and not bad_field(message)
    assert 30 < refused < 300


FLOATS = [
    (topic, name)
    for topic in topics.TABLE
    if not topic.text  # these are JSON or text, and JSON has no word for them
    for name, hint in typing.get_type_hints(topic.type).items()
    if hint in (float, list[float], tuple[float, float, float])
]


@pytest.mark.parametrize(("topic", "name"), FLOATS, ids=lambda v: getattr(v, "key", v))
def test_what_is_no_number_never_gets_in(topic: Topic[Any], name: str) -> None:
    message = Payloads(1).message(topic.type)
    codec.decode(topic, msgspec.msgpack.encode(message))
    hint = typing.get_type_hints(topic.type)[name]
    for value in (math.nan, math.inf, -math.inf, 1e300, -1e300):
        setattr(message, name, value if hint is float else [0.0, value, 0.0])
        with pytest.raises(codec.DecodeError, match=name):
            codec.decode(topic, msgspec.msgpack.encode(message))


def test_a_bad_number_is_found_however_deep() -> None:
    def ref(x: float) -> m.ObjectRef:
        return m.ObjectRef(label="mug", position=(0.0, x, 0.0))

    assert bad_field(m.ManipulationGoal(goal="grab", object=ref(math.nan))) == "object"
    assert not bad_field(m.ManipulationGoal(goal="grab", object=ref(1.0)))
    assert not bad_field(m.ManipulationGoal(goal="grab"))
    world = m.WorldObjects(
        t=0.0, objects=[m.WorldObject(label="", kind="", colour="", position=(0, 0, 0), size=(1, 1, math.inf))]
    )
    assert bad_field(world) == "objects"
    assert bad_field(m.NavPath(t=0.0, points=[(0.0, 0.0), (0.0, 2e15)])) == "points"
    assert not bad_field(m.BrainState(state="IDLE", t=1.8e9))
