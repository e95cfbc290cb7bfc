// Logarithmic scale in front of a look-up table: log10 of the value. What is not positive lies below
// every range, as in vtkLookupTable.

//@ fragment instead //pvfiblets::Scale::Impl
    fibletValue = fibletValue > 0.0 ? log(fibletValue) * 0.4342944819032518 : -3.0e38;
