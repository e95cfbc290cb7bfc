// A line's normal: perpendicular to its tangent and as near to the viewer as that allows, as VTK does
// for its lit lines. Where the line runs straight at the viewer every perpendicular is as good: the
// direction to the viewer itself is taken. The effects (ambient occlusion) read it too, lit or not.

//@ fragment instead //VTK::Normal::Impl
  vec3 fibletToViewer = cameraParallel == 1 ? vec3(0.0, 0.0, 1.0) : normalize(-vertexVC.xyz);
  vec3 fibletTangentVC = normalize(fibletDataToView * fibletTangent);
  vec3 normalVCVSOutput = fibletToViewer - fibletTangentVC * dot(fibletTangentVC, fibletToViewer);
  float fibletNormalLength = length(normalVCVSOutput);
  normalVCVSOutput = fibletNormalLength > 1e-3 ? normalVCVSOutput / fibletNormalLength : fibletToViewer;
