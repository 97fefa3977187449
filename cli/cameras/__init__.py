"""Calibration of the cameras' mounts: `tidybot calibrate`."""
