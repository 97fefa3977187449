"""What became of the cases, for terminal, JSON and HTML."""
