"""Between motor and shaft: rigid teeth, teeth with play, teeth that give."""
