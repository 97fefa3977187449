"""`python -m services.brain`."""

from common.runtime import main
from services.brain.service import BrainService

if __name__ == "__main__":
    main(BrainService)
