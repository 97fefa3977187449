"""The robot for agents: a server of the Model Context Protocol, `tidybot mcp`."""
