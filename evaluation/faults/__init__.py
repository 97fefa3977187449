"""What can go wrong, done on purpose: to messages, hosts, processes and the world itself."""
