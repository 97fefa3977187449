import sys
from typing import Any

from common.runtime import main
from services.dashboard.service import DashboardService

LEFT_OUT: tuple[str, ...] = ("cv2", "networkx", "shapely")
"""What Viser and trimesh import where it is there and do without as well: 40 MB for faster JPEGs, graphs and curves."""

if __name__ == "__main__":
    absent: dict[str, Any] = dict.fromkeys(LEFT_OUT)
    sys.modules.update(absent)
    main(DashboardService)
