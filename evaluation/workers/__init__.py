"""Where cases run: in lanes of this machine or of a cluster."""
