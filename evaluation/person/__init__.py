"""The person who talks to the robot: wishes, answers and voice."""
