// Logarithmic scale in front of a look-up table: log10 of the value. What is not positive lies below every range, as in
// vtkLookupTable. Where values are less by a reference above 0, both logarithms are: log10(1 + value / reference).

uniform float colour_reference;

float logarithm(float value) {
    float share = colour_reference > 0.0 ? value / colour_reference : -1.0;
    float ratio = colour_reference > 0.0 ? 1.0 + share : value + colour_reference;
    // 1 + share would round a small share away; the series is right to its fourth power.
    return abs(share) < 0.01
        ? share * (1.0 - share * (0.5 - share * (0.33333333 - 0.25 * share))) * 0.4342944819032518
        : ratio > 0.0 ? log(ratio) * 0.4342944819032518 : -3.0e38;
}
