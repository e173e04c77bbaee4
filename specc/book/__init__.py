"""Books: the complete set of specifications of an architecture, for whoever builds the robot.

origins, sources   which files it is made of, under which names
manifest           what book.json says
tables             fields as numbers, for readers without specc
contents           all that the book is made of, gathered once
chapters           what its pages say
folder             written whole, read back, and checked
"""
