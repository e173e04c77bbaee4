"""Why a robot departs from its spec: numbers refitted, and candidates tried on held-out windows."""
