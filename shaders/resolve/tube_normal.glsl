// The surface normal of tubes, as the engine found it for every pixel, in place of a line's.
//
//   fibletNormalMap    r32ui   unit normal, data coordinates, octahedral, 2 x 16 bit

//@ fragment after //VTK::CustomUniforms::Dec
uniform usampler2D fibletNormalMap;
uniform mat3 fibletNormalToView;       // normals: data -> view coordinates

//@ fragment after //VTK::Normal::Impl
  uint fibletNormalWord = texelFetch(fibletNormalMap, fibletPixel, 0).r;
//pvfiblets::NormalWord::Impl
  normalVCVSOutput = normalize(fibletNormalToView * fibletDirection(fibletNormalWord));
