from common.runtime import main
from services.ros2.service import Ros2Service

if __name__ == "__main__":
    main(Ros2Service)
