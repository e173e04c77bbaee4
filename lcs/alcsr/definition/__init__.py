"""ALCSR in plain Python: the definition that is read; kernels give the same bits.

Thesis, sections 4.3.1 to 4.3.5, a file each. It is slow on purpose: lists of organisms, one idea to
a function. Chance is drawn in the order in which the lines stand, so that the compiled core gives
the same bits. Begin with `cycle`.
"""
