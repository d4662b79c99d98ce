"""What the controller and the plant say of themselves on `/diagnostics`."""
