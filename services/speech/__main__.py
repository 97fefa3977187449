from common.runtime import main
from services.speech.service import SpeechService

if __name__ == "__main__":
    main(SpeechService)
