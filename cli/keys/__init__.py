"""Certificates: `tidybot keys`."""
