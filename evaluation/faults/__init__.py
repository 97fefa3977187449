"""Fault injection: into messages, hosts, processes and the simulated world."""
