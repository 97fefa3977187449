"""What the robot relies on from its drivers: `tidybot conform`."""
