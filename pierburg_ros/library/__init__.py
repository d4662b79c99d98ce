"""What `import pierburg_ros` offers: a function for each job, and results that can be shown, saved and put into tables.

The commands are thin shells over these functions, so that a notebook and a terminal give the same numbers and files.
"""
