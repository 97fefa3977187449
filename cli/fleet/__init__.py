"""Several robots: where each is, what it does, and which of them a command goes to."""
