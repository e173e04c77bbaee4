"""Rules as they are read, written, drawn and thinned out, whichever learner found them."""
