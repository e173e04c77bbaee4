"""Changes of mode, judged by their time and by the jumps that come with them."""
