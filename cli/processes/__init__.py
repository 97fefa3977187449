"""The robot as processes: what is started, how it is supervised, and `tidybot up`, `down`, `ps`, `restart`, `logs`."""
