"""Recordings of all topics: `tidybot record`, `replay`."""
