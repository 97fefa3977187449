"""`python -m services.perception`."""

from common.runtime import main
from services.perception.service import PerceptionService

if __name__ == "__main__":
    main(PerceptionService)
