"""Logs of every kind, read record by record: what is whole is handed on, each loss is counted."""
