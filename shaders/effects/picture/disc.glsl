// The share of a pixel, d pixels from the centre, that a disc of radius r covers; below half a pixel it is the centre's own.
float disc(float r, float d)
{
    return clamp(max(r, 0.5) + 0.5 - d, 0.0, 1.0);
}
