// Logarithmic scale in front of a look-up table: log10 of the value. What is not positive lies below every range, as in
// vtkLookupTable. Where values are less by a reference above 0, both logarithms are: log10(1 + value / reference).

//@ fragment after //VTK::CustomUniforms::Dec
uniform float fibletTableReference;

//@ fragment instead //pvfiblets::Scale::Impl
    float fibletShare = fibletTableReference > 0.0 ? fibletValue / fibletTableReference : -1.0;
    float fibletRatio = fibletTableReference > 0.0 ? 1.0 + fibletShare : fibletValue + fibletTableReference;
    // 1 + share would round a small share away; the series is right to its fourth power.
    fibletValue = abs(fibletShare) < 0.01
      ? fibletShare * (1.0 - fibletShare * (0.5 - fibletShare * (0.33333333 - 0.25 * fibletShare))) * 0.4342944819032518
      : fibletRatio > 0.0 ? log(fibletRatio) * 0.4342944819032518 : -3.0e38;
