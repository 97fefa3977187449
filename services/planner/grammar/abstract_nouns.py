"""Nouns of what cannot be carried: `bring me luck` asks for nothing that could be found. Pure.

Those single words of WordNet 3.0 (Princeton University, 2006; wordnet.princeton.edu/license-and-commercial-use) that
are counted four times or more in its tagged texts and whose senses are all acts, attributes, cognitions, events,
feelings, states, times and the like, and words that are such where somebody is asked for them (`give me a hand`).
"""

from importlib.resources import files

ABSTRACT: frozenset[str] = frozenset((files(__package__) / "abstract_nouns.txt").read_text(encoding="utf-8").split())
