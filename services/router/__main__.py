"""A Zenoh router in Python, for runs without Docker."""

from services.router.router import main

if __name__ == "__main__":
    main()
