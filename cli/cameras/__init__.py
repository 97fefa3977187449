"""Where the cameras really sit: `tidybot calibrate`."""
