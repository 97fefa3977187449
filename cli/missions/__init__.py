"""What people ask of the robot and what became of it: `tidybot say`, `status`, `missions`, `explain`, `demo`."""
