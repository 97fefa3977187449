"""Reports of an evaluation for terminal, JSON and HTML."""
