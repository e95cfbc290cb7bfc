// Colours that a legend explains, as the legend has them: no light changes them. Highlights are added, where there are any.

//@ fragment replace diffuse = diffuse * diffuseColor;
diffuse = diffuseColor;
//@ fragment replace vec3 diffuse = df * diffuseColor * lightColor0;
vec3 diffuse = diffuseColor;
