"""Commands about the robot's home: `tidybot map`, `places`, `rules`, `teach`, `forget`."""
