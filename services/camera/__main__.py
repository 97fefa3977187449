from common.runtime import main
from services.camera.service import CameraService

if __name__ == "__main__":
    main(CameraService)
