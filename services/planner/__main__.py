from common.runtime import main
from services.planner.service import PlannerService

if __name__ == "__main__":
    main(PlannerService)
