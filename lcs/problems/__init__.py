"""Problems to learn: inputs and the rewards of all actions, drawn by a seed."""
