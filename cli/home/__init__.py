"""What the robot is told of its home: `tidybot map`, `places`, `rules`, `teach`, `forget`."""
