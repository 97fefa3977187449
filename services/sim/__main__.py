from common.runtime import main
from services.sim.service import SimService

if __name__ == "__main__":
    main(SimService)
