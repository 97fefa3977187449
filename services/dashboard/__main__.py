from common.runtime import main
from services.dashboard.service import DashboardService

if __name__ == "__main__":
    main(DashboardService)
