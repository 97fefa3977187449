"""Demonstrations for learning: missions as episodes of a LeRobotDataset, `tidybot record --lerobot`."""
