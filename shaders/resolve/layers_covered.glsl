// What other pieces put in front of lines (halos, outlines) is there once, with the nearest layer (layers.glsl); it hides those
// behind it.

//@ fragment after //pvfiblets::Key::Impl
  if (fibletLayer > 0 && fibletKey != fibletLayerKey)
  {
    fibletKey = fibletEmpty;
  }
