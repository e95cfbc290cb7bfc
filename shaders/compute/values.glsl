// The per-point value of the G-buffer, if the style asks for one; otherwise nothing but zeros is left of this file.

void begin_values(uint f) {}
void start_values(uint segment) {}
float value_at(uint segment, float t) { return 0.0; }
