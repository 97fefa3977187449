from common.runtime import main
from services.mapping.service import MappingService

if __name__ == "__main__":
    main(MappingService)
