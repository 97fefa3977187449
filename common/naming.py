"""Names people use for objects and places, matched to the household's."""

import difflib
import re
from collections.abc import Iterable

from common.household import Household
from common.messages import WorldObject

_FILLER = {"the", "a", "an", "my", "that", "this", "some", "please", "to", "of"}


def normalise(text: str) -> str:
    """Lower case, no punctuation, no articles."""
    words = re.sub(r"[^a-z0-9 ]+", " ", text.lower()).split()
    return " ".join(w for w in words if w not in _FILLER)


def match_object(query: str, objects: Iterable[WorldObject], household: Household) -> list[WorldObject]:
    """The known objects that a phrase can mean: by taught name, by name or alias, else by colour and kind, else by
    kind."""
    wanted = normalise(query)
    known = list(objects)
    if taught := [o for o in known if wanted in o.names]:
        return taught
    spec = next(
        (o for o in household.things if wanted == normalise(o.name) or wanted in map(normalise, o.aliases)), None
    )
    names = {wanted, normalise(spec.name)} if spec else {wanted}
    exact = [o for o in known if normalise(o.label) in names]
    if exact:
        return exact
    words = set(wanted.split())
    return [o for o in known if o.kind and words and words <= {o.kind, o.colour, *normalise(o.label).split()}]


def near_names(query: str, names: Iterable[str]) -> list[str]:
    """Names that look like the query, for error messages."""
    return difflib.get_close_matches(normalise(query), list(names), n=3, cutoff=0.5)
