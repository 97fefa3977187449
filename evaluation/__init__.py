"""Runs scenarios against the real services and judges them by physics alone."""
