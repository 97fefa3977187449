"""Commands about missions: `tidybot say`, `status`, `missions`, `explain`, `demo`."""
