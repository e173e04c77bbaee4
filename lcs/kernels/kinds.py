"""What a cycle was, as kernels write it; `lcs.course.Kind` says what each means.

It stands here since machine code is kept by a hash of the kernels' sources.
"""

TEST, TRIED, FORCED = range(3)
