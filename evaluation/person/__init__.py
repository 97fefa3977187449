"""The simulated user: wishes, answers and voice."""
