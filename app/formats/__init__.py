"""Heart: pure bytes ⇄ samples: file layouts and wire protocols. It knows columns, units and axis order."""
