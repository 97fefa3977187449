"""The robot's battery: what computer, base and arm draw of it, and what is left."""

from math import hypot

CAPACITY = 500.0
"""Energy of a full battery [Wh]; chosen: a portable power station of the middle size."""
IDLE = 50.0
"""What computer, sensors and drivers draw at rest [W]; chosen: a small computer with two cameras and a lidar."""
ARM = 36.0
"""What the arm draws [W]. Source: Kinova Gen3 user guide, average power."""
ROLLING = 250.0
"""What the base draws for its speed [W per m/s]; chosen: 70 kg on carpet through geared motors."""
TURNING = 50.0
"""The same for its rate of turn [W per rad/s]; chosen."""


class Battery:
    """`charge`: 0 empty to 1 full; `power` [W] as drawn last."""

    def __init__(self, charge: float = 1.0) -> None:
        self.charge, self.power = charge, IDLE + ARM

    def draw(self, vx: float, vy: float, omega: float, seconds: float) -> None:
        """Take the charge of so many seconds at these velocities of the base [m/s, m/s, rad/s]."""
        self.power = IDLE + ARM + ROLLING * hypot(vx, vy) + TURNING * abs(omega)
        self.charge = max(0.0, self.charge - self.power * seconds / (3600.0 * CAPACITY))
