"""Arbiters against logs: does the robot decide as the spec says (thesis, chapter 4, stage 6)?"""
