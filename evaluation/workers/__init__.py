"""Running cases in child processes (lanes), on this machine or on a cluster."""
