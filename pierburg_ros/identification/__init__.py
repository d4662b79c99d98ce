"""Parameters from data: static characteristic, step response, fits of whole recordings, excitation."""
