// Logarithmic scale in front of a look-up table: log10 of the value; what is not positive counts as
// the lower end of the range, as in vtkLookupTable.

//@ fragment instead //pvfiblets::Scale::Impl
    fibletValue = fibletValue > 0.0 ? log(fibletValue) * 0.4342944819032518 : fibletTableRange.x;
