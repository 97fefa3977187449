"""The suites of scenarios, and what they are made of."""
