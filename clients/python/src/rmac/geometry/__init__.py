"""Places and curves as moves take them."""
