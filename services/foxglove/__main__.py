from common.runtime import main
from services.foxglove.service import FoxgloveService

if __name__ == "__main__":
    main(FoxgloveService)
