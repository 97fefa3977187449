"""Several robots: overview of their states, and dispatch of commands to the best one."""
