"""Perception on pictures as the robot's camera has them, with faces and print."""
