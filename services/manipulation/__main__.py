from common.runtime import main
from services.manipulation.service import ManipulationService

if __name__ == "__main__":
    main(ManipulationService)
