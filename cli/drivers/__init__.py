"""Conformance test of drivers: `tidybot conform`."""
