"""From recordings to statements: motion, balance, shortlist, fit, choice, a file a stage."""
