"""Multiple shooting: windows of the trace, predicted from fitted starts."""
