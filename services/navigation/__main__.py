from common.runtime import main
from services.navigation.service import NavigationService

if __name__ == "__main__":
    main(NavigationService)
