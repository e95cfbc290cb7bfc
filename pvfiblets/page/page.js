// Built by `make client` of sources ffaa6b8cbefcbd6f
"use strict";(()=>{var bt=Object.defineProperty;var vt=(o,e,n)=>e in o?bt(o,e,{enumerable:!0,configurable:!0,writable:!0,value:n}):o[e]=n;var h=(o,e,n)=>vt(o,typeof e!="symbol"?e+"":e,n);var T=class extends Error{},wt=101010256,yt=101075792,xt=117853008,At=33639248,He=67324752,Xe="header.json",me="Copy or make the file again.",_t=4096;function J(o,e){return o.getUint32(e,!0)+o.getUint32(e+4,!0)*4294967296}function Et(o){let e=o.byteLength;for(let n=e-22;n>=Math.max(0,e-65558);--n)if(o.getUint32(n,!0)===wt){if(n>=20&&o.getUint32(n-20,!0)===xt){let t=J(o,n-12);if(t+56<=e&&o.getUint32(t,!0)===yt)return[J(o,t+48),J(o,t+32)]}return[o.getUint32(n+16,!0),o.getUint16(n+10,!0)]}throw new T("This is no whole .fiblets file: the end of its zip archive is missing. Copy or make it again.")}function Tt(o,e,n,t){let r=o.getUint32(e+24,!0),s=o.getUint32(e+42,!0),i=o.getUint32(e+20,!0);for(let a=e+46+n,l=a+t;a+4<=l;){let c=o.getUint16(a,!0),u=o.getUint16(a+2,!0),f=a+4;c===1&&(r===4294967295&&(r=J(o,f),f+=8),i===4294967295&&(i=J(o,f),f+=8),s===4294967295&&(s=J(o,f))),a+=4+u}return[r,s]}var Ft={"|u1":[1,Uint8Array],"|i1":[1,Int8Array],"|b1":[1,Uint8Array],"<u2":[2,Uint16Array],"<i2":[2,Int16Array],"<u4":[4,Uint32Array],"<i4":[4,Int32Array],"<f4":[4,Float32Array],"<f8":[8,Float64Array],"<i8":[8,BigInt64Array],"<u8":[8,BigUint64Array]};function Pe(o,e){let n=new T(`The member ${e} of the file is damaged. ${me}`);if(o.length<10||o[0]!==147||o[6]!==1)throw n;let t=o[8]|o[9]<<8,r=new TextDecoder("latin1").decode(o.subarray(10,10+t)),s=/'descr':\s*'([^']+)'/.exec(r),i=/'shape':\s*\(([^)]*)\)/.exec(r);if(!s||!i||/'fortran_order':\s*True/.test(r))throw n;let a=Ft[s[1]];if(!a)return null;let l=i[1].split(",").map(p=>p.trim()).filter(p=>p).map(Number),c=l.reduce((p,g)=>p*g,1),u=o.byteOffset+10+t;if(!l.every(p=>Number.isSafeInteger(p)&&p>=0)||10+t+c*a[0]>o.length)throw n;let f=o.buffer,d=u%a[0]===0?new a[1](f,u,c):new a[1](f.slice(u,u+c*a[0]),0,c);return{shape:l,data:d}}function Oe(o){let e=new DataView(o.buffer,o.byteOffset,o.byteLength);if(o.length<22)throw new T("This is no .fiblets file: it is empty, or cut short.");let[n,t]=Et(e),r=new Map,s=null,i=n;for(let a=0;a<t;++a){if(i+46>o.length||e.getUint32(i,!0)!==At)throw new T(`The list of the file's members is damaged. ${me}`);let l=e.getUint16(i+28,!0),c=e.getUint16(i+30,!0),u=e.getUint16(i+32,!0),f=new TextDecoder().decode(o.subarray(i+46,i+46+l)),[d,p]=Tt(e,i,l,c);if(e.getUint16(i+10,!0)!==0)throw new T(`The member ${f} of the file is compressed; .fiblets files store their members as they are.`);if(p+30>o.length||e.getUint32(p,!0)!==He)throw new T(`The member ${f} of the file is damaged. ${me}`);let g=p+30+e.getUint16(p+26,!0)+e.getUint16(p+28,!0);if(g+d>o.length)throw new T(`The file ends within its member ${f}. Copy or make it again.`);let b=o.subarray(g,g+d);if(f===Xe)s=We(b);else{let m=Pe(b,f);m&&r.set(f,m)}i+=46+l+c+u}return Ke(s,r,1/0)}function We(o){try{return JSON.parse(new TextDecoder().decode(o))}catch{throw new T(`The file's header is damaged. ${me}`)}}function Ke(o,e,n){if(o===null||typeof o!="object")throw new T("This is a zip archive, but no .fiblets file: it has no header.json.");return{header:o,arrays:e,ready:n}}async function Je(o,e){let{bytes:n}=o,t=new DataView(n.buffer,n.byteOffset,n.byteLength),r=new Map,s=null;for(let i=0;i+30<=n.length&&(await o.need(i,Math.min(i+_t,n.length)),t.getUint32(i,!0)===He);){let a=t.getUint16(i+26,!0),l=t.getUint16(i+28,!0),c=i+30+a+l,u=new TextDecoder().decode(n.subarray(i+30,i+30+a)),f=t.getUint32(i+18,!0);for(let d=i+30+a;f===4294967295&&d+20<=c;d+=4+t.getUint16(d+2,!0))t.getUint16(d,!0)===1&&(f=J(t,d+4));if(t.getUint16(i+8,!0)!==0||c+f>n.length)throw new T(`The member ${u} of the file is damaged. ${me}`);if(u===Xe)await o.need(c,c+f),s=We(n.subarray(c,c+f));else{let d=Pe(n.subarray(c,c+f),u);d&&r.set(u,d),d&&(d.data.buffer!==n.buffer||u==="pages.npy")&&(await o.need(c,c+f),r.set(u,Pe(n.subarray(c,c+f),u)))}if(r.has("codes.npy")&&e.every(d=>r.has(s?.per_point?.[d]?.member)))break;i=c+f}return Ke(s,r,0)}var Rt=[["anchors.npy",2,-1],["decoding.npy",3,-1],["anchors_low.npy",3,-1],["rank_to_id.npy",1,0],["codes.npy",1,1]];async function je(o,e,n,t,r,s){let i=e.arrays.get("pages.npy").data,a=e.header.n_fiblets,l=[...Rt,...s.map(c=>[e.header.per_point?.[c]?.member,1,2])];await Promise.all(l.map(([c,u,f])=>{let d=e.arrays.get(c)?.data;if(!d)return;let[p,g]=[n,t].map(b=>(f<0?Math.min(b*r,a)*u:Number(i[3*b+f]))*d.BYTES_PER_ELEMENT);return o.need(d.byteOffset+p,Math.min(d.byteOffset+g+(f===1?4:0),o.bytes.length))}))}var Q={blocks:{ClipPlanes:{bytes:400,fields:{clip_brushes:256,clip_plane_count:384,clip_planes:0,clip_rounding:388,clip_tilts:128}},Coding:{bytes:96,fields:{anchor_scale:0,end_vector_scale:28,lattice_edge:24,radius_scale:12,rotation_scales:32,step_low:16,step_span:20}},Frame:{bytes:208,fields:{half_line_width:172,line_reach:184,most_pixels_per_mm:192,plane_rounding:188,reference:160,segment_deviation:200,segment_size:204,view_planes:64,viewport:176,w_per_mm:196,window_from_local:0}},Rays:{bytes:5632,fields:{rays_centres:3072,rays_first_layers:4096,rays_first_tallies:5120,rays_layer_counts:4608,rays_rectangles:3584,rays_rows:0}},Rotations:{bytes:16384,fields:{rotations:0}}},fields:{anchor_x:[0,0,16],anchor_y:[0,16,16],anchor_z:[1,0,16],begin:[1,30,1],cap:[2,26,4],code:[1,0,22],end:[1,31,1],kind:[2,30,2],last:[2,20,6],point:[2,0,20],rank:[1,16,14],shape:[0,0,32],step:[1,22,10]},lines:`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define FEATURE_ANCHORS_LOW 1
#define FEATURE_LATTICE 1
#define FEATURE_WIDE_LATTICE 1
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))-1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32-offset-bits))>>(32-bits);
const uint FIBLET_PAGE_BITS=14u;
const float FIBLET_DIRECTION_SCALE=32767.0;
const float FIBLET_STEP_LEVELS=1023.0;
const uint FIBLET_WIDE_HEADER=20u;
const uint FIBLET_PLAIN_BYTES=12u;
const uint FIBLET_DECODING_WORDS=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_WIDE=3u;
uint fiblet_anchor_x(uvec2 words){return bitfieldExtract(words.x,0,16);}
uint fiblet_anchor_y(uvec2 words){return bitfieldExtract(words.x,16,16);}
uint fiblet_anchor_z(uvec2 words){return bitfieldExtract(words.y,0,16);}
uint fiblet_rank(uvec2 words){return bitfieldExtract(words.y,16,14);}
uint fiblet_begin(uvec2 words){return bitfieldExtract(words.y,30,1);}
uint fiblet_end(uvec2 words){return bitfieldExtract(words.y,31,1);}
uint fiblet_shape(uvec3 words){return bitfieldExtract(words.x,0,32);}
uint fiblet_code(uvec3 words){return bitfieldExtract(words.y,0,22);}
uint fiblet_step(uvec3 words){return bitfieldExtract(words.y,22,10);}
uint fiblet_last(uvec3 words){return bitfieldExtract(words.z,20,6);}
uint fiblet_cap(uvec3 words){return bitfieldExtract(words.z,26,4);}
uint fiblet_kind(uvec3 words){return bitfieldExtract(words.z,30,2);}
ivec3 fiblet_end_vector(uint word){return ivec3(bitfieldExtract(int(word),0,10),bitfieldExtract(int(word),10,10),bitfieldExtract(int(word),20,10));}
layout(std140)uniform Frame{
mat4 window_from_local;
vec4 view_planes[6];
uvec3 reference;
float half_line_width;
vec2 viewport;
float line_reach;
float plane_rounding;
float most_pixels_per_mm;
float w_per_mm;
float segment_deviation;
float segment_size;
};
layout(std140)uniform Coding{
vec3 anchor_scale;
float radius_scale;
float step_low;
float step_span;
float lattice_edge;
float end_vector_scale;
vec4 rotation_scales[4];
layout(std140)uniform Rotations{
uvec4 rotations[1024];
const int ROW_BITS=12;
const uint chunk_first_rank=0u,chunk_pages=0u;
uniform highp usampler2D anchor_texels;
uniform highp usampler2D page_texels;
uniform highp usampler2D decoding_texels;
uniform highp usampler2D code_texels;
uniform uint chunk_fiblets;
ivec2 texel(uint index){return ivec2(int(index&((1u<<uint(ROW_BITS))-1u)),int(index>>uint(ROW_BITS)));}
uvec2 anchor_words(uint f){return texelFetch(anchor_texels,texel(f),0).xy;}
uvec4 page_words(uint row){return texelFetch(page_texels,texel(row),0);}
uint decoding_word(uint index){return texelFetch(decoding_texels,texel(index),0).x;}
uint code_word(uint index){return texelFetch(code_texels,texel(index),0).x;}
uint rotation_word(uint index){return rotations[index>>2][index&3u];}
uint bound_word(uint index){return 0u;}
const uint chunk_end_words=0u;
#if FEATURE_ANCHORS_LOW
uniform highp usampler2D anchor_low_texels;
uint anchor_low_word(uint index){return texelFetch(anchor_low_texels,texel(index),0).x;}
#endif
uint anchor_low(uint index){return bitfieldExtract(anchor_low_word(index>>1),int(index&1u)*16,16);}
float difference(uint a,uint b){return a>=b?float(a-b):-float(b-a);}
vec3 anchor_local(uint f){
uvec2 words=anchor_words(f);
uvec3 q=uvec3(fiblet_anchor_x(words),fiblet_anchor_y(words),fiblet_anchor_z(words));
q=(q<<16u)|uvec3(anchor_low(3u*f),anchor_low(3u*f+1u),anchor_low(3u*f+2u));
vec3 d=vec3(difference(q.x,reference.x),difference(q.y,reference.y),difference(q.z,reference.z));
#else
vec3 d=vec3(ivec3(q)-ivec3(reference));
vec3 p=d*anchor_scale;
return p;
bool begins(uint f){return fiblet_begin(anchor_words(f))!=0u;}
bool ends(uint f){return fiblet_end(anchor_words(f))!=0u;}
uint rank_of(uint f){return page_words(f>>FIBLET_PAGE_BITS).x+fiblet_rank(anchor_words(f));}
uvec3 decoding_words(uint f){
uint at=FIBLET_DECODING_WORDS*f;
return uvec3(decoding_word(at),decoding_word(at+1u),decoding_word(at+2u));
uint first_code(uint f,uvec3 words){return page_words(f>>FIBLET_PAGE_BITS).y+fiblet_code(words);}
uint code_at(uint byte){return bitfieldExtract(code_word(byte>>2),int(byte&3u)*8,8);}
uint codes_at(uint byte){
uint word=byte>>2,shift=(byte&3u)*8u;
uint low=code_word(word);
return shift==0u?low:(low>>shift)|(code_word(word+1u)<<(32u-shift));
float rotation_scale(uint cap){return rotation_scales[cap>>2][cap&3u];}
vec4 rotation(uint cap,uint code,float scale){
int word=int(rotation_word((cap<<8u)+code));
vec2 t=scale*vec2(bitfieldExtract(word,0,16),bitfieldExtract(word,16,16));
float w=sqrt(1.0-t.x*t.x-t.y*t.y);
return vec4(0.0,t,w);
float sign_of(int value){return value<0?-1.0:1.0;}
float step_length(uvec3 words){return step_low+float(fiblet_step(words))*(step_span/FIBLET_STEP_LEVELS);}
vec4 first_frame(uint shape){
int u=bitfieldExtract(int(shape),0,16),v=bitfieldExtract(int(shape),16,16);
bool forward=abs(u)+abs(v)<=int(FIBLET_DIRECTION_SCALE);
vec2 s=vec2(float(u),float(v))/FIBLET_DIRECTION_SCALE;
float x=1.0-abs(s.x)-abs(s.y);
vec3 d=forward?vec3(x,s)
:vec3(x,(1.0-abs(s.y))*sign_of(u),(1.0-abs(s.x))*sign_of(v));
d=d/sqrt(dot(d,d));
vec3 h=forward?vec3(1.0+d.x,-d.z,d.y):vec3(1.0-d.x,d.z,-d.y);
h=h/sqrt(dot(h,h));
return forward?vec4(0.0,h.y,h.z,h.x):vec4(h.y,0.0,h.x,-h.z);
vec3 rotated_x(vec4 q){
vec3 d=vec3(1.0-2.0*(q.y*q.y+q.z*q.z),2.0*(q.x*q.y+q.w*q.z),2.0*(q.x*q.z-q.w*q.y));
return d;
vec4 turned(vec4 a,vec4 t){
vec4 q=vec4(a.x*t.w+a.y*t.z-a.z*t.y,a.w*t.y-a.x*t.z+a.y*t.w,
a.w*t.z+a.x*t.y+a.z*t.w,a.w*t.w-a.y*t.y-a.z*t.z);
return q;
#if FEATURE_LATTICE
void lattice_box(uvec3 words,inout uint byte,out ivec3 lo,out uvec2 n,out uint width){
int shape=int(fiblet_shape(words));
lo=ivec3(bitfieldExtract(shape,0,8),bitfieldExtract(shape,8,8),bitfieldExtract(shape,16,8));
n=uvec2((uint(shape)>>24u)+1u,(fiblet_step(words)&255u)+1u);
width=fiblet_kind(words);
#if FEATURE_WIDE_LATTICE
if(fiblet_kind(words)==KIND_WIDE&&fiblet_last(words)>0u){
width=fiblet_step(words)&7u;
if(width==0u){
lo=ivec3(0);
width=FIBLET_PLAIN_BYTES;
return;
lo=ivec3(codes_at(byte),codes_at(byte+4u),codes_at(byte+8u));
n=uvec2(codes_at(byte+12u),codes_at(byte+16u));
byte+=FIBLET_WIDE_HEADER;
ivec3 lattice_cell(uint byte,uint width,ivec3 lo,uvec2 n){
if(width==FIBLET_PLAIN_BYTES)return lo+ivec3(codes_at(byte),codes_at(byte+4u),codes_at(byte+8u));
uint code=codes_at(byte)&(0xFFFFFFFFu>>(32u-8u*width));
uint row=code/n.x;
return lo+ivec3(code-row*n.x,row%n.y,row/n.y);
struct Walk{
uint last;
uint kind;
uint byte;
uint cap;
float scale;
float step;
uint width;
uvec2 n;
ivec3 lo;
ivec3 k;
Walk walk;
vec3 walk_anchor;
vec3 walk_point;
vec3 walk_delta;
vec4 walk_frame;
void walk_begin(uint f){
uvec3 words=decoding_words(f);
walk_anchor=anchor_local(f);
walk_point=walk_anchor;
walk_delta=vec3(0.0);
walk.last=fiblet_last(words);
walk.kind=fiblet_kind(words);
walk.byte=first_code(f,words);
walk.cap=fiblet_cap(words);
walk.scale=rotation_scale(walk.cap);
walk.step=step_length(words);
walk_frame=first_frame(fiblet_shape(words));
if(walk.kind!=KIND_DIRECTION){
walk.k=ivec3(0);
walk.step=lattice_edge*exp2(-float(fiblet_cap(words)));
lattice_box(words,walk.byte,walk.lo,walk.n,walk.width);
void walk_next(uint i){
ivec3 cell=lattice_cell(walk.byte,walk.width,walk.lo,walk.n);
walk.byte+=walk.width;
walk.k+=cell;
walk_delta=walk.step*vec3(cell);
walk_point=walk_anchor+walk.step*vec3(walk.k);
if(i>1u){
walk_frame=turned(walk_frame,rotation(walk.cap,code_at(walk.byte+i-2u),walk.scale));
walk_delta=walk.step*rotated_x(walk_frame);
walk_point+=walk_delta;
vec3 end_vector(uint f){
uint word=bound_word(chunk_end_words+rank_of(f)-chunk_first_rank);
vec3 v=end_vector_scale*vec3(fiblet_end_vector(word));
return v;
vec3 first_segment(uint f){
if(fiblet_last(words)==0u)return ends(f)?vec3(0.0):anchor_local(f+1u)-anchor_local(f);
if(fiblet_kind(words)!=KIND_DIRECTION){
uint byte=first_code(f,words),width;
lattice_box(words,byte,lo,n,width);
return lattice_edge*exp2(-float(fiblet_cap(words)))*vec3(lattice_cell(byte,width,lo,n));
return step_length(words)*rotated_x(first_frame(fiblet_shape(words)));
vec3 direction_after(uint f,bool whole){
if(ends(f)||f+1u>=chunk_fiblets)return vec3(0.0);
if(!whole)return first_segment(f+1u);
return ends(f+1u)?end_vector(f+1u):anchor_local(f+2u)-anchor_local(f+1u);
uint packed_direction(vec3 d){
float norm=abs(d.x)+abs(d.y)+abs(d.z);
vec2 s=d.yz/norm;
if(d.x<0.0)s=(1.0-abs(s.yx))*vec2(s.x<0.0?-1.0:1.0,s.y<0.0?-1.0:1.0);
ivec2 i=ivec2(round(clamp(s,-1.0,1.0)*FIBLET_DIRECTION_SCALE));
return uint(i.x&0xFFFF)|(uint(i.y)<<16u);
uint packed_tangent(vec3 delta,uint before){
float size=max(abs(delta.x),max(abs(delta.y),abs(delta.z)));
return size>0.0?packed_direction(delta/size):before;
vec3 unit_or_none(vec3 d){
float size=max(abs(d.x),max(abs(d.y),abs(d.z)));
return size>0.0?normalize(d/size):vec3(0.0);
vec3 mean_direction(vec3 before,vec3 after){
vec3 sum=before+after;
float square=dot(sum,sum);
return square>1e-6?sum*inversesqrt(square):before;
layout(location=0)in uvec2 item;
uniform uint share_size;
flat out uvec4 o0;flat out uvec4 o1;flat out uvec4 o2;flat out uvec4 o3;flat out uvec4 o4;flat out uvec4 o5;
flat out uvec4 o6;flat out uvec4 o7;flat out uvec4 o8;flat out uvec4 o9;flat out uvec4 o10;flat out uvec4 o11;
flat out uvec4 o12;flat out uvec4 o13;flat out uvec4 o14;
uvec4 slots[15];
uvec4 slot(vec3 point,vec3 tangent){return uvec4(floatBitsToUint(point),packed_tangent(tangent,0u));}
void main(){
uint f=item.x,first=item.y*share_size,stop=first+share_size;
bool end=ends(f);
walk_begin(f);
uint last=walk.last;
vec3 point=walk_point,next=end||f+1u>=chunk_fiblets?vec3(0.0):anchor_local(f+1u),before=vec3(0.0),tangent;
for(uint i=0u;i<=min(last,stop-1u);++i){
vec3 here=point,run;
if(i<last){
walk_next(i+1u);
run=walk_delta;
point=walk_point;
}else run=end?vec3(0.0):next-here;
vec3 along=unit_or_none(run);
tangent=i==0u?along:mean_direction(before,along);
if(i>=first)slots[i-first]=slot(here,tangent);
if(along!=vec3(0.0))before=along;
if(last+1u<stop){
vec3 beyond=vec3(0.0);
if(end)next=point;
else beyond=direction_after(f,false);
if(end&&last==0u&&!begins(f)&&f>0u){
walk_begin(f-1u);
for(uint i=1u;i<=walk.last;++i)walk_next(i);
tangent=unit_or_none(next-walk_point);
if(first==0u)slots[0]=slot(next,tangent);
}else if(beyond!=vec3(0.0))tangent=unit_or_none(beyond);
for(uint i=max(last+1u,first);i<stop;++i)slots[i-first]=slot(i==last+1u?next:next+beyond,tangent);
o0=slots[0];o1=slots[1];o2=slots[2];o3=slots[3];o4=slots[4];o5=slots[5];o6=slots[6];o7=slots[7];
o8=slots[8];o9=slots[9];o10=slots[10];o11=slots[11];o12=slots[12];o13=slots[13];o14=slots[14];
gl_Position=vec4(0.0);
out vec4 colour;
void main(){colour=vec4(0.0);}
#define FEATURE_CLIP_PLANES 1
#define FEATURE_POINT_MASK 1
#define FEATURE_STREAMLINE_MASK 1
#define FEATURE_VALUES_COLOUR 1
#define FEATURE_VALUES_STORED 1
#define FEATURE_WIDE_LINES 1
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
vec4 to_homogeneous(vec3 p){
vec4 c=window_from_local[0]*p.x+window_from_local[1]*p.y+window_from_local[2]*p.z
+window_from_local[3];
return c;
vec3 above_lower(vec4 c){
vec3 d=c.xyz+vec3(vec2(half_line_width),0.0)*c.w;
vec3 below_upper(vec4 c){
vec3 d=vec3(viewport+half_line_width,1.0)*c.w-c.xyz;
bool in_volume(vec4 c){
return all(greaterThanEqual(above_lower(c),vec3(0.0)))&&all(greaterThanEqual(below_upper(c),vec3(0.0)));
vec4 to_window(vec4 c){
float r=1.0/max(c.w,1e-30);
vec4 window=vec4(c.xyz*r,c.w);
return window;
bool clip_segment(vec4 a,vec4 b,out float t0,out float t1){
t0=0.0;
t1=1.0;
vec3 a_low=above_lower(a),a_high=below_upper(a),b_low=above_lower(b),b_high=below_upper(b);
for(int side=0;side<6;++side){
int axis=side>>1;
float da=(side&1)==0?a_low[axis]:a_high[axis],db=(side&1)==0?b_low[axis]:b_high[axis];
if(da<0.0&&db<0.0)return false;
float t=da/(da-db);
if(da<0.0)t0=max(t0,t);
else if(db<0.0)t1=min(t1,t);
return t0<=t1;
const vec2 CELL_SHIFT=vec2(23.0,23.0)/256.0;
vec2 in_picture(vec4 window){
return clamp(window.xy,vec2(0.0),viewport-0.01);
vec2 pixel_of(vec4 window){return floor(in_picture(window));}
#if FEATURE_CLIP_PLANES
layout(std140)uniform ClipPlanes{
vec4 clip_planes[8];
vec2 clip_tilts[8];
float clip_brushes[8];
int clip_plane_count;
float clip_rounding;
float clip_height_of(int plane,vec3 p){
float h=dot(clip_planes[plane].xyz,p)+clip_planes[plane].w;
return h;
float clip_height(vec3 p){
float least=clip_height_of(0,p);
for(int plane=1;plane<clip_plane_count;++plane)least=min(least,clip_height_of(plane,p));
return least;
bool clip_by_planes(vec3 a,vec3 b,inout float t0,inout float t1){
for(int plane=0;plane<clip_plane_count;++plane){
float ha=clip_height_of(plane,a),hb=clip_height_of(plane,b);
if(ha<0.0&&hb<0.0)return false;
float t=ha/(ha-hb);
if(ha<0.0)t0=max(t0,t);
else if(hb<0.0)t1=min(t1,t);
bool on_kept_side(vec3 p){return clip_height(p)>=0.0;}
bool clip_by_planes(vec3 a,vec3 b,inout float t0,inout float t1){return true;}
bool on_kept_side(vec3 p){return true;}
struct Vertex{
vec3 local;
vec4 clip;
vec4 window;
bool inside;
struct ClippedSegment{
vec4 a;
vec4 b;
float t0;
float t1;
bool start;
bool cap;
float reach;
bool thin;
Vertex vertex_of(vec3 p){
vec4 clip=to_homogeneous(p);
vec4 window=to_window(clip);
bool inside=true;
inside=in_volume(clip)&&on_kept_side(p);
return Vertex(p,clip,window,inside);
bool clip_in_space(Vertex from,Vertex to,inout ClippedSegment piece){
if(from.inside&&to.inside)return true;
float t0,t1;
if(!clip_segment(from.clip,to.clip,t0,t1))return false;
if(!clip_by_planes(from.local,to.local,t0,t1))return false;
if(t0>0.0)piece.a=to_window(from.clip+t0*(to.clip-from.clip));
if(t1<1.0)piece.b=to_window(from.clip+t1*(to.clip-from.clip));
piece=ClippedSegment(piece.a,piece.b,t0,t1,piece.start||t0>0.0,piece.cap||t1<1.0,0.0,false);
return true;
bool piece_of(Vertex from,Vertex to,bool start,bool cap,out ClippedSegment piece){
piece=ClippedSegment(from.window,to.window,0.0,1.0,start,cap,0.0,false);
return clip_in_space(from,to,piece);
bool piece_of(vec3 from,vec3 to,bool start,bool cap,out ClippedSegment piece){
return piece_of(vertex_of(from),vertex_of(to),start,cap,piece);
const float JOINT_LEAST=0.1,JOINT_OVERLAP=0.05;
vec2 onward_at(vec4 end,vec3 ahead){
vec4 c=window_from_local[0]*ahead.x+window_from_local[1]*ahead.y+window_from_local[2]*ahead.z;
vec2 run=c.xy-end.xy*c.w;
float size=length(run);
return size>JOINT_LEAST*end.w?run/size:vec2(0.0);
vec3 unpacked_tangent(uint word){
ivec2 s=ivec2(int(word<<16)>>16,int(word)>>16);
vec2 p=vec2(s)/FIBLET_DIRECTION_SCALE;
float x=1.0-abs(p.x)-abs(p.y);
if(x<0.0)p=(1.0-abs(p.yx))*vec2(s.x<0?-1.0:1.0,s.y<0?-1.0:1.0);
return normalize(vec3(x,p));
const int FAR_TILE=4;
#ifndef VARYING
#define VARYING flat out
VARYING uvec2 seg_ids;
VARYING vec3 seg_tangent;
VARYING vec3 seg_tangent_to;
VARYING vec4 seg_start;
VARYING vec4 seg_end;
VARYING vec4 seg_along;
#if FEATURE_VALUES_COLOUR
VARYING uvec2 seg_colours;
#if FEATURE_WIDE_LINES
VARYING vec2 seg_onward;
VARYING vec3 seg_from;
VARYING vec3 seg_to;
const bool SPRITES=false;
layout(location=0)in uvec4 slot_from;
layout(location=1)in uvec4 slot_to;
layout(location=2)in uvec4 slot_after;
uniform int share_size;
uniform highp usampler2D items;
uniform int first_item;
uniform uint layer;
#if FEATURE_STREAMLINE_MASK
uniform highp usampler2D kept;
#if FEATURE_POINT_MASK
uniform highp usampler2D kept_points;
bool point_kept(uint point){
uint word=point>>5u;
return((texelFetch(kept_points,ivec2(int(word&4095u),int(word>>12u)),0).x>>(point&31u))&1u)!=0u;
uniform highp sampler2D point_colours;
vec4 colour_of(uint point){return texelFetch(point_colours,ivec2(int(point&4095u),int(point>>12u)),0);}
#if FEATURE_VALUES_STORED
uniform highp usampler2D value_texels;
uniform vec3 value_code;
float value_of(uint point){
uint code=texelFetch(value_texels,ivec2(int(point&4095u),int(point>>12u)),0).x;
return float(code)==value_code.z?uintBitsToFloat(0x7FC00000u):value_code.x+value_code.y*float(code);
uniform highp usampler2D far_tiles;
bool hidden(ClippedSegment piece){
vec2 reach=vec2(half_line_width>0.0?half_line_width+1.0:0.0),low=min(piece.a.xy,piece.b.xy)-reach,high=max(piece.a.xy,piece.b.xy)+reach;
ivec2 last=textureSize(far_tiles,0)-1;
ivec2 from=clamp(ivec2(low)/FAR_TILE,ivec2(0),last),to=clamp(ivec2(high)/FAR_TILE,ivec2(0),last);
if(any(greaterThan(to-from,ivec2(1))))return false;
uint farthest=max(max(texelFetch(far_tiles,from,0).x,texelFetch(far_tiles,to,0).x),
max(texelFetch(far_tiles,ivec2(from.x,to.y),0).x,texelFetch(far_tiles,ivec2(to.x,from.y),0).x));
return min(piece.a.z,piece.b.z)-abs(piece.b.z-piece.a.z)>uintBitsToFloat(farthest);
int index=SPRITES?gl_VertexID:gl_InstanceID,place=first_item+index/share_size;
uvec4 item=texelFetch(items,ivec2(place&((1<<ROW_BITS)-1),place>>ROW_BITS),0);
uint points=item.z&63u,share=item.z>>8u;
bool begins=(item.z&64u)!=0u,ends=(item.z&128u)!=0u;
uint k=share*uint(share_size)+uint(index%share_size),count=points-(ends&&points>1u?1u:0u);
gl_Position=vec4(2.0,2.0,2.0,1.0);
gl_PointSize=1.0;
if(k>=count)return;
if(texelFetch(kept,ivec2(int(item.x&4095u),int(item.x>>12u)),0).x==0u)return;
bool start=k==0u&&begins,cap=k+1u==count&&ends;
uint here=item.y+k,there=item.y+min(k+1u,points-(ends?1u:0u));
if(!point_kept(here)||!point_kept(there))return;
start=start||!point_kept(here-1u);
cap=cap||!point_kept(there+1u);
vec2 values=vec2(0.0);
values=vec2(value_of(here),value_of(there));
vec3 from=uintBitsToFloat(slot_from.xyz),to=uintBitsToFloat(slot_to.xyz);
ClippedSegment piece;
if(!piece_of(from,to,start,cap,piece)||hidden(piece))return;
seg_ids=uvec2(item.x|layer,(piece.start?1u:0u)|(piece.cap?2u:0u));
seg_tangent=unpacked_tangent(slot_from.w);
seg_tangent_to=unpacked_tangent(slot_to.w);
seg_start=piece.a;
seg_end=piece.b;
seg_along=vec4(piece.t0,piece.t1,values);
seg_colours=uvec2(packUnorm4x8(colour_of(here)),packUnorm4x8(colour_of(there)));
seg_onward=piece.cap?vec2(0.0):onward_at(piece.b,uintBitsToFloat(slot_after.xyz)-to);
seg_from=mix(from,to,piece.t0);
seg_to=mix(from,to,piece.t1);
vec2 a=piece.a.xy,run=piece.b.xy-a;
float size=length(run),reach=half_line_width+0.05,back=piece.start?reach:0.05;
vec2 along=size>0.0?run/size:vec2(1.0,0.0),across=vec2(-along.y,along.x);
vec2 at=((gl_VertexID&2)==0?a-back*along:piece.b.xy+reach*along)+((gl_VertexID&1)==0?-reach:reach)*across;
gl_Position=vec4(2.0*at/viewport-1.0,0.0,1.0);
vec2 p=pixel_of(piece.a)+0.5+CELL_SHIFT,q=pixel_of(piece.b)+0.5+CELL_SHIFT,run=q-p;
float square=dot(run,run),size=sqrt(square);
if(size==0.0&&!piece.cap)return;
if(SPRITES){
float pixels=max(abs(run.x),abs(run.y))+(piece.cap?1.0:0.0);
gl_PointSize=pixels;
gl_Position=vec4(2.0*(p-CELL_SHIFT+0.5*(pixels-1.0)*sign(run+1e-3))/viewport-1.0,0.0,1.0);
const float reach=0.75;
vec2 at=((gl_VertexID&2)==0?p-reach*along:q+reach*along)+((gl_VertexID&1)==0?-reach:reach)*across;
float depth=square>0.0?piece.a.z+dot(at-p,run)/square*(piece.b.z-piece.a.z):piece.b.z;
gl_Position=vec4(2.0*at/viewport-1.0,2.0*clamp(depth,0.0,0.99999988)-1.0,1.0);
#define FEATURE_CLIP_REGION 1
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
struct Cells{
ivec2 first;
vec2 run;
int count;
float shift;
float inverse;
float square;
Cells cells_between(ivec2 p,ivec2 q){
ivec2 run=q-p,size=abs(run);
int n=max(size.x,size.y);
bool steep=size.y>size.x;
float shift=steep?(run.y<0?-CELL_SHIFT.y:CELL_SHIFT.y):(run.x<0?-CELL_SHIFT.x:CELL_SHIFT.x);
vec2 way=vec2(run);
return Cells(p,way,n,shift,1.0/float(max(n,1)),1.0/max(dot(way,way),1.0));
const float EDGE_STEPS=448.0;
const float EDGE_LEAST=2.0;
const float WIDTH_STEPS=32.0;
uint packed_edges(vec2 n,float e,float w,uint end){
vec2 q=n/max(abs(n.x)+abs(n.y),1e-30);
int turn=int((q.y>=0.0?1.0-q.x:3.0+q.x)*512.0+0.5)&2047;
int inside=int(clamp((e+EDGE_LEAST)*EDGE_STEPS+0.5,0.0,2047.0));
int across=int(clamp(w*WIDTH_STEPS+0.5,1.0,127.0));
return uint(turn|(inside<<11)|(across<<22))|(end<<29u);
uint capsule_edges(vec2 centre,vec2 run,float r){
vec2 away=centre-clamp(dot(centre,run)/max(dot(run,run),1e-12),0.0,1.0)*run;
float size=length(away);
vec2 n=size>1e-4?away/size:vec2(-run.y,run.x)/max(length(run),1e-6);
return packed_edges(n,r-size,2.0*r,0u);
#if !FEATURE_WIDE_LINES
uint thin_edges(ivec2 first,ivec2 last,vec2 at,vec4 parts,bool start,bool cap){
vec2 run=vec2(last-first),a=parts.xy-0.5-at,d=run+parts.zw-parts.xy;
float square=dot(d,d),shrink=inversesqrt(max(square,1e-6));
vec2 along=square>1e-6?d:vec2(1.0,0.0);
float left=(along.y*a.x-along.x*a.y)*shrink;
bool turned=left<0.0,begins=start&&at==vec2(0.0),ends=cap&&at==run;
float stop=dot(along,begins?a:a+d)*shrink;
uint third=uint(int(2.5+clamp(turned?3.0*stop:-3.0*stop,-1.0,1.0)));
uint end=begins&&ends?7u:begins||ends?(turned==ends?third:third+3u):0u;
return packed_edges(turned?vec2(along.y,-along.x):vec2(-along.y,along.x),0.5-abs(left),1.0,end);
bool beyond_joint(vec2 onward,vec2 away){return dot(onward,away)>JOINT_OVERLAP;}
struct Tangents{vec3 start;vec3 end;};
vec3 tangent_between(Tangents ends,float t){
vec3 d=mix(ends.start,ends.end,t);
return dot(d,d)>1e-6?d:ends.start;
#if FEATURE_CLIP_REGION
layout(std140)uniform Rays{
vec4 rays_rows[192];
vec3 rays_centres[32];
ivec4 rays_rectangles[32];
int rays_first_layers[32];
int rays_layer_counts[32];
int rays_first_tallies[32];
const vec2 RAYS_NOWHERE=vec2(3.0,-3.0);
const float RAYS_FAR=3.0;
float rays_bounded(float z){return clamp(z,-RAYS_FAR,RAYS_FAR);}
vec2 rays_planes(int leaf,int planes,vec2 pixel){
vec3 centre=rays_centres[leaf];
vec2 d=pixel-centre.xy,span=vec2(-RAYS_FAR,RAYS_FAR);
for(int k=0;k<planes;++k){
vec4 row=rays_rows[6*leaf+k];
float height=dot(row.xy,d)+row.w;
if(row.z==0.0){
if(height<0.0)return RAYS_NOWHERE;
continue;
float z=rays_bounded(centre.z-height/row.z);
if(row.z>0.0)span.x=max(span.x,z);
else span.y=min(span.y,z);
return span.x<=span.y?span:RAYS_NOWHERE;
vec2 rays_sphere(int leaf,vec2 pixel){
vec2 d=pixel-centre.xy;
vec4 xy=rays_rows[6*leaf],slope=rays_rows[6*leaf+1],along=rays_rows[6*leaf+2];
float a=along.x,b=along.y+slope.z*d.x+slope.w*d.y;
float c=xy.w+d.x*(slope.x+xy.x*d.x+xy.z*d.y)+d.y*(slope.y+xy.y*d.y);
float discriminant=b*b-a*c;
if(!(discriminant>=0.0))return a<0.0?vec2(-RAYS_FAR,RAYS_FAR):RAYS_NOWHERE;
float q=-(b+(b<0.0?-1.0:1.0)*sqrt(discriminant));
float one=q==0.0?0.0:c/q,other=a==0.0?(b<0.0?RAYS_FAR:-RAYS_FAR):q/a;
one=rays_bounded(centre.z+one);
other=rays_bounded(centre.z+other);
return vec2(a<0.0?-RAYS_FAR:min(one,other),a<0.0?min(one,other):max(one,other));
bool along(vec2 span,float z){return span.x<=z&&z<span.y;}
bool planes_hold(int leaf,int planes,float z){return along(rays_planes(leaf,planes,gl_FragCoord.xy),z);}
bool sphere_holds(int leaf,float z){return along(rays_sphere(leaf,gl_FragCoord.xy),z);}
#define REGION planes_hold(0, 6, z) || sphere_holds(1, z)
bool region_keeps(float z){return REGION;}
#define VARYING flat in
layout(location=0)out uvec4 out_texel;
uniform vec2 shown_values;
bool none(float value){return(floatBitsToUint(value)&0x7FFFFFFFu)>0x7F800000u;}
float value_between(float t){
vec2 ends=seg_along.zw;
if(none(ends.x)||none(ends.y))return t<0.5?ends.x:ends.y;
return mix(ends.x,ends.y,t);
void write(float s,uint edges){
if(!region_keeps(clamp(mix(seg_start.z,seg_end.z,s),0.0,0.99999988)))discard;
float ratio=seg_start.w/max(seg_end.w,1e-30);
float t=mix(seg_along.x,seg_along.y,clamp(s*ratio/max(1.0-s+s*ratio,1e-30),0.0,1.0));
uint bits=0u;
float value=value_between(t);
if(shown_values.x<=shown_values.y&&!(value>=shown_values.x&&value<=shown_values.y))discard;
bits=floatBitsToUint(value);
bits=packUnorm4x8(mix(unpackUnorm4x8(seg_colours.x),unpackUnorm4x8(seg_colours.y),t));
out_texel=uvec4(seg_ids.x,packed_tangent(tangent_between(Tangents(seg_tangent,seg_tangent_to),t),0u),edges,bits);
bool brush_kept(float s,vec2 away){
vec2 heights=vec2(clip_height_of(plane,seg_from),clip_height_of(plane,seg_to));
vec2 h=max(heights/max(vec2(seg_start.w,seg_end.w),vec2(1e-30)),vec2(0.0));
if(h.x+s*(h.y-h.x)+dot(clip_tilts[plane],away)<0.0)return false;
vec2 run=seg_end.xy-seg_start.xy,centre=gl_FragCoord.xy-seg_start.xy;
float foot=dot(centre,run)/max(dot(run,run),1e-12),s=clamp(foot,0.0,1.0);
vec2 away=centre-s*run;
if(foot<0.0&&(seg_ids.y&1u)==0u||dot(away,away)>half_line_width*half_line_width)discard;
if(foot>1.0&&beyond_joint(seg_onward,centre-run))discard;
if(!brush_kept(s,away))discard;
gl_FragDepth=clamp(seg_start.z+(seg_end.z-seg_start.z)*s,0.0,0.99999988);
write(s,capsule_edges(centre,run,half_line_width));
vec2 first=pixel_of(seg_start),run=pixel_of(seg_end)-first,at=floor(gl_FragCoord.xy)-first;
Cells cells=cells_between(ivec2(first),ivec2(first+run));
bool start=(seg_ids.y&1u)!=0u,cap=(seg_ids.y&2u)!=0u,steep=abs(run.y)>abs(run.x);
float s=1.0;
if(at==run){
if(!cap)discard;
}else{
float major=steep?at.y:at.x,way=steep?run.y:run.x,steps=abs(major);
if(major*way<0.0||steps>=float(cells.count))discard;
vec2 line=floor(0.5+CELL_SHIFT+(steps-cells.shift)*cells.inverse*run);
if(steep?line.x!=at.x:line.y!=at.y)discard;
s=dot(at-CELL_SHIFT,run)*cells.square;
if(SPRITES)gl_FragDepth=clamp(mix(seg_start.z,seg_end.z,s),0.0,0.99999988);
vec4 ends=vec4(in_picture(seg_start),in_picture(seg_end)),parts=floor((ends-floor(ends))*256.0)/256.0;
write(s,thin_edges(ivec2(first),ivec2(first+run),at,parts,start,cap));
void main(){gl_Position=vec4(gl_VertexID==1?3.0:-1.0,gl_VertexID==2?3.0:-1.0,0.0,1.0);}
const int TILE=16;
uniform highp usampler2D texels;
layout(location=0)out uint some;
ivec2 size=textureSize(texels,0),from=max(ivec2(gl_FragCoord.xy)*TILE-1,ivec2(0));
ivec2 stop=min(ivec2(gl_FragCoord.xy)*TILE+TILE+1,size);
some=0u;
for(int y=from.y;y<stop.y&&some==0u;++y)
for(int x=from.x;x<stop.x;++x){
uvec4 texel=texelFetch(texels,ivec2(x,y),0);
some|=~(texel.x&texel.y);
some=min(some,1u);
uniform highp sampler2D depths;
layout(location=0)out uint farthest;
ivec2 from=ivec2(gl_FragCoord.xy)*FAR_TILE,stop=min(from+FAR_TILE,textureSize(depths,0));
float most=0.0;
for(int y=from.y;y<stop.y&&most<1.0;++y)
for(int x=from.x;x<stop.x;++x)most=max(most,texelFetch(depths,ivec2(x,y),0).r);
farthest=floatBitsToUint(most);
uniform highp usampler2D tiles;
uniform vec2 whole;
int columns=textureSize(tiles,0).x;
ivec2 tile=ivec2(gl_InstanceID%columns,gl_InstanceID/columns);
vec2 corner=vec2(TILE*(tile+ivec2(gl_VertexID&1,gl_VertexID>>1)));
gl_Position=texelFetch(tiles,tile,0).x==0u?vec4(2.0,2.0,2.0,1.0):vec4(2.0*corner/whole-1.0,0.0,1.0);
const int MOST_LIGHTS=8;
uniform int light_count;
uniform vec3 light_colour[MOST_LIGHTS];
uniform vec4 light_place[MOST_LIGHTS];
uniform vec3 light_sum;
uniform float light_standing;
vec3 to_light(int i,vec3 place){return normalize(light_place[i].xyz-light_place[i].w*place);}
float across_line(vec3 tangent,vec3 d){
float along=dot(tangent,d);
along*=along;
return max(0.0,1.0-along*along);
vec3 light_on_line(vec3 own,vec3 tangent,vec3 place,bool illuminated,vec4 reflects,vec3 sheen){
vec3 sight=normalize(-place),normal=sight-tangent*dot(tangent,sight);
normal=length(normal)>1e-3?normalize(normal):sight;
vec3 diffuse=vec3(0.0),shine=vec3(0.0);
for(int i=0;i<light_count;++i){
vec3 l=to_light(i,place);
float along=dot(tangent,l),sine=sqrt(max(0.0,1.0-along*along));
diffuse+=light_colour[i]*(illuminated?sine:across_line(tangent,l));
if(reflects.z>0.0){
float spread=illuminated?sine:sqrt(max(0.0,1.0-along*along));
vec3 back=-along*tangent+spread*normal;
shine+=light_colour[i]*pow(max(1e-5,dot(back,sight)),reflects.w);
vec3 on;
if(illuminated)on=diffuse/max(1.0,max(light_sum.r,max(light_sum.g,light_sum.b)));
else{
float brightest=max(light_sum.r,max(light_sum.g,light_sum.b));
vec3 tint=light_sum/max(brightest,1e-6);
tint=mix(vec3(1.0),tint,1.0-min(tint.r,min(tint.g,tint.b)));
vec3 share=min(diffuse/max(light_sum,vec3(1e-6)),vec3(1.0));
share=mix(vec3(across_line(tangent,vec3(-0.57735027,0.57735027,0.57735027))),share,light_standing);
on=min(brightest,1.0)*tint*mix(vec3(0.6),vec3(1.0),share);
return reflects.x*own+reflects.y*on*own+reflects.z*sheen*shine;
uniform highp sampler2D table;
uniform vec4 table_range;
uniform int logarithm;
vec4 of_value(float value){
int n=int(table_range.w),entry;
if((floatBitsToUint(value)&0x7FFFFFFFu)>0x7F800000u)entry=n+2;
if(logarithm==1)value=value>0.0?log(value)*0.4342944819032518:-3.0e38;
if(value<table_range.x)entry=n;
else if(value>table_range.y)entry=n+1;
else entry=int(min((value-table_range.x)*table_range.z,float(n-1)));
return texelFetch(table,ivec2(entry&4095,entry>>12),0);
uniform highp sampler2D colours;
uniform int mode;
uniform vec3 one_colour;
uniform int light;
uniform vec4 reflects;
uniform vec3 sheen;
uniform highp usampler2D chosen;
uniform vec4 chosen_colour;
uniform vec4 faded;
uniform uint marked;
uniform mat3 data_to_view;
uniform mat4 pixel_to_view;
uniform vec2 picture;
layout(location=0)out vec4 colour;
ivec2 pixel=ivec2(gl_FragCoord.xy);
uvec4 word=texelFetch(texels,pixel,0);
if(word.y==0xFFFFFFFFu&&word.x==0xFFFFFFFFu||(word.x&0xF0000000u)!=layer)discard;
uint streamline=word.x&0x0FFFFFFFu;
vec3 tangent=unpacked_tangent(word.y);
vec4 own=vec4(one_colour,1.0);
if(mode==0)own=vec4(abs(tangent),1.0);
else if(mode==2)own=texelFetch(colours,ivec2(int(streamline&4095u),int(streamline>>12u)),0);
else if(mode==3)own=of_value(uintBitsToFloat(word.w));
else if(mode==4)own=unpackUnorm4x8(word.w);
if(own.a==0.0)discard;
if(chosen_colour.a+faded.a>0.0){
uint is_chosen=texelFetch(chosen,ivec2(int(streamline&4095u),int(streamline>>12u)),0).r;
vec4 mark=is_chosen!=0u?chosen_colour:faded;
own.rgb=mix(own.rgb,mark.rgb,mark.a);
vec3 lit=own.rgb;
if(light!=0){
vec2 ndc=2.0*(vec2(pixel)+0.5)/picture-1.0;
vec4 place=pixel_to_view*vec4(ndc,2.0*texelFetch(depths,pixel,0).r-1.0,1.0);
lit=light_on_line(own.rgb,normalize(data_to_view*tangent),place.xyz/place.w,light==2,reflects,sheen);
if(streamline==marked)lit=mix(lit,vec3(1.0,0.9,0.2),0.75);
colour=vec4(lit,1.0);
uniform highp sampler2D drawn;
uniform float narrower;
layout(location=0)out uvec4 shown;
uint thinned(uint word){
uint inside=(word>>11u)&2047u,width=(word>>22u)&127u;
inside-=min(inside,uint(0.5*narrower*EDGE_STEPS+0.5));
width-=min(width-1u,uint(narrower*WIDTH_STEPS+0.5));
return(word&0xE00007FFu)|(inside<<11u)|(width<<22u);
ivec2 pixel=ivec2(gl_FragCoord.xy)-1;
shown=uvec4(0u);
if(any(lessThan(pixel,ivec2(0)))||any(greaterThanEqual(pixel,textureSize(texels,0))))return;
uvec4 texel=texelFetch(texels,pixel,0);
bool line=texel.x!=0xFFFFFFFFu||texel.y!=0xFFFFFFFFu;
shown=uvec4(floatBitsToUint(texelFetch(depths,pixel,0).r),line?thinned(texel.z):0u,packUnorm4x8(texelFetch(drawn,pixel,0)),0u);
struct Edges{
vec2 n;
float e;
float w;
uint end;
float stop;
Edges unpacked_edges(uint word){
float turn=float(int(word&2047u))/512.0,x=abs(turn-2.0)-1.0;
int width=int((word>>22u)&127u),end=int(word>>29u);
return Edges(normalize(vec2(x,turn<2.0?1.0-abs(x):abs(x)-1.0)),
float(int((word>>11u)&2047u))/EDGE_STEPS-EDGE_LEAST,width==127?128.0:float(width)/WIDTH_STEPS,
uint(end),float(end>3?end-5:end-2)/3.0);
uniform usampler2D shown;
uniform ivec2 shift;
const vec4 X0=vec4(1.5,2.5,5.5,6.5),X1=vec4(-2.5,-1.5,-5.5,-7.5);
const vec4 Y0=vec4(1.5,5.5,3.5,7.5),Y1=vec4(2.5,6.5,4.5,0.5);
const vec4 X2=vec4(4.5,3.5,0.5,7.5),X3=vec4(-0.5,-4.5,-3.5,-6.5);
const vec4 Y2=vec4(-0.5,-4.5,-6.5,-3.5),Y3=vec4(-2.5,-1.5,-5.5,-7.5);
const uint EVERY=0x01010101u,SAMPLE=12u,PIXEL=16u*SAMPLE;
const int OWN=4;
struct Band{
float away;
float size;
uint bits(bvec4 inside){
return(inside.x?1u:0u)|(inside.y?0x100u:0u)|(inside.z?0x10000u:0u)|(inside.w?0x1000000u:0u);
uint count(uint samples){return(samples*EVERY)>>24u;}
Band band_of(Edges edges,vec2 at,bool there){
float along=edges.n.x*at.y-edges.n.y*at.x;
bool beyond=edges.end==7u||edges.end!=0u&&(edges.end<4u)==(along>edges.stop);
return Band(edges.n/16.0,dot(edges.n,at)-edges.e+0.5*edges.w,there&&!beyond?0.5*edges.w:-1.0);
uint covered(Band band,vec4 x,vec4 y){
return bits(lessThanEqual(abs(band.n.x*x+band.n.y*y+band.away),vec4(band.size)));
uint within(Edges edges,vec4 x,vec4 y){
vec4 along=(edges.n.x*y-edges.n.y*x)/16.0;
vec2 range=edges.end==7u?vec2(-0.5,0.5)
:vec2(edges.end<4u?-1.0:edges.stop,edges.end>0u&&edges.end<4u?edges.stop:1.0);
return bits(lessThanEqual(abs(along-0.5*(range.x+range.y)),vec4(0.5*(range.y-range.x))));
uvec4 around[9];
Band bands[9];
uint visible[9];
uint shares[9];
uint behind[9];
uint lines[9];
#define NINE(what) what(0, -1, -1) what(1, 0, -1) what(2, 1, -1) what(3, -1, 0) what(4, 0, 0) what(5, 1, 0) what(6, -1, 1) what(7, 0, 1) what(8, 1, 1)
#define EIGHT(what) what(0, -1, -1) what(1, 0, -1) what(2, 1, -1) what(3, -1, 0) what(5, 1, 0) what(6, -1, 1) what(7, 0, 1) what(8, 1, 1)
#define FETCH(k, right, up) around[k] = texelFetch(shown, pixel + ivec2(right, up), 0);
#define BEGIN(k, right, up) bands[k] = band_of(unpacked_edges(around[k].y), -vec2(right, up), around[k].y != 0u && (line || around[k].x < around[OWN].x)); behind[k] = line && around[k].y == 0u && around[k].x > around[OWN].x ? 1u : 0u; lines[k] = line && around[k].y != 0u ? 1u : 0u; visible[k] = shares[k] = 0u;
#define QUARTER(right, up, a, b, c) { uint m = covered(bands[OWN], right, up) & within(own, right, up), ma = covered(bands[a], right, up), mb = covered(bands[b], right, up), mc = covered(bands[c], right, up), open = EVERY & ~((m | ma) | (mb | mc)), left = count(open); bool a_first = around[a].x < depth, b_first = around[b].x < depth, c_first = around[c].x < depth, ab = around[a].x <= around[b].x, ac = around[a].x <= around[c].x, bc = around[b].x <= around[c].x; visible[OWN] += m & ~((a_first ? ma : 0u) | (b_first ? mb : 0u) | (c_first ? mc : 0u)); visible[a] += ma & ~((a_first ? 0u : m) | (ab ? 0u : mb) | (ac ? 0u : mc)); visible[b] += mb & ~((b_first ? 0u : m) | (ab ? ma : 0u) | (bc ? 0u : mc)); visible[c] += mc & ~((c_first ? 0u : m) | (ac ? ma : 0u) | (bc ? mb : 0u)); uint backs = behind[a] + behind[b] + behind[c], fronts = lines[a] + lines[b] + lines[c], n = backs > 0u ? backs : fronts; left *= n == 3u ? SAMPLE / 3u : n == 2u ? SAMPLE / 2u : SAMPLE; shares[a] += left * (backs > 0u ? behind[a] : lines[a]); shares[b] += left * (backs > 0u ? behind[b] : lines[b]); shares[c] += left * (backs > 0u ? behind[c] : lines[c]); shares[OWN] += n == 0u ? left : 0u; }
#define ADOPT(k) if (abs(bands[k].away) <= bands[k].size && around[k].x < depth) { depth = around[k].x; bands[OWN] = bands[k]; of_own = around[k].z; }
#define SHARE(k, right, up) shares[k] += SAMPLE * count(visible[k]);
#define ADD(k, right, up) red_blue += shares[k] * (around[k].z & 0xFF00FFu); green_alpha += shares[k] * ((around[k].z >> 8u) & 0xFF00FFu);
ivec2 pixel=ivec2(gl_FragCoord.xy)+shift;
NINE(FETCH)
if(((around[0].y|around[1].y|around[2].y)|(around[3].y|around[4].y|around[5].y)
|(around[6].y|around[7].y|around[8].y))==0u)discard;
Edges own=unpacked_edges(around[OWN].y);
bool line=around[OWN].y!=0u;
EIGHT(BEGIN)
bands[OWN]=Band(own.n/16.0,0.5*own.w-own.e,line?0.5*own.w:-1.0);
visible[OWN]=shares[OWN]=0u;
uint depth=around[OWN].x,of_own=around[OWN].z;
if(!line){ADOPT(1)ADOPT(3)ADOPT(5)ADOPT(7)}
QUARTER(X0,Y0,5,7,8)
QUARTER(X1,Y1,3,7,6)
QUARTER(X2,Y2,5,1,2)
QUARTER(X3,Y3,3,1,0)
EIGHT(SHARE)
uint mine=SAMPLE*count(visible[OWN]);
if(shares[OWN]+(line?mine:0u)==PIXEL)discard;
uint red_blue=mine*(of_own&0xFF00FFu),green_alpha=mine*((of_own>>8u)&0xFF00FFu);
NINE(ADD)
colour=vec4(red_blue&0xFFFFu,green_alpha&0xFFFFu,red_blue>>16u,green_alpha>>16u)/(255.0*float(PIXEL));
void main(){colour=vec4(texelFetch(drawn,ivec2(gl_FragCoord.xy),0).rgb,1.0);}
uniform vec3 bottom;
uniform vec3 top;
uniform float height;
void main(){colour=vec4(mix(bottom,top,gl_FragCoord.y/height),1.0);}
layout(location=0)in vec3 place;
layout(location=1)in vec3 normal;
layout(location=2)in vec4 own;
layout(location=3)in float value;
uniform mat4 clip_from_data;
uniform mat4 view_from_data;
uniform mat3 normal_to_view;
out vec3 view_place;
out vec3 view_normal;
out vec4 own_colour;
out vec3 data_place;
out float own_value;
gl_Position=clip_from_data*vec4(place,1.0);
view_place=(view_from_data*vec4(place,1.0)).xyz;
view_normal=normal_to_view*normal;
own_colour=own;
data_place=place;
own_value=value;
vec3 light_on_surface(vec3 own,vec3 normal,vec3 place,vec4 reflects,vec3 sheen){
vec3 diffuse=vec3(0.0),shine=vec3(0.0),sight=normalize(-place);
float facing=max(0.0,dot(normal,l));
diffuse+=facing*light_colour[i];
if(reflects.z>0.0&&facing>0.0)shine+=light_colour[i]*pow(max(0.0,dot(reflect(-l,normal),sight)),reflects.w);
return reflects.x*own+reflects.y*diffuse*own+reflects.z*sheen*shine;
in vec3 view_place;
in vec3 view_normal;
in vec4 own_colour;
in vec3 data_place;
in float own_value;
uniform int smooth_normals;
uniform int lighting;
uniform int by_value;
uniform float parallel;
uniform float opacity;
uniform int plane_count;
uniform vec4 planes[6];
for(int i=0;i<plane_count;++i)if(dot(planes[i].xyz,data_place)+planes[i].w<0.0)discard;
vec3 normal=smooth_normals==1?normalize(view_normal):normalize(cross(dFdx(view_place),dFdy(view_place)));
vec3 sight=parallel==1.0?vec3(0.0,0.0,1.0):normalize(-view_place);
if(dot(normal,sight)<0.0)normal=-normal;
vec4 own=by_value==1?of_value(own_value):own_colour;
vec3 lit=lighting==1?light_on_surface(own.rgb,normal,view_place,reflects,sheen):own.rgb;
colour=vec4(lit,own.a*opacity);
uniform vec3 corner;
uniform vec3 across;
uniform vec3 up;
out vec2 at;
at=vec2(gl_VertexID&1,gl_VertexID>>1);
gl_Position=clip_from_data*vec4(corner+at.x*across+at.y*up,1.0);
in vec2 at;
uniform highp sampler2D pixels;
colour=texture(pixels,at);
if(colour.a<=0.002)discard;
colour.a*=opacity;`,page_bits:14,rotation_scales:[39380907423947065e-23,5413425014921813e-22,7445069627465273e-22,1023472805172787e-21,14070004681343562e-22,19338988295203308e-22,2657444838405354e-21,3649580548881204e-21,5006992068956606e-21,6855771061964333e-21,9352394044981338e-21,1266809158551041e-20,1692779733275529e-20,22030990294297226e-21,27206533559365198e-21,300810752378311e-19],rotations:"AAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbRuK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6nLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420biuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07Svlg==",shaders:{"effects/picture/antialias_coverage.frag":[0,5,476,479,711,717,46,47,717,723,10,11,723,725,257,258,725,732,712,713,732,734,46,47,734,736,10,11,736,741,10,11,741,743,10,11,743,748,10,11,748,762,226,227,762,783,10,11],"page/background.frag":[0,5,784,787,674,675,787,788],"page/copy.frag":[0,5,697,698,674,675,783,784],"page/decode.vert":[0,13,10,11,13,55,46,47,55,57,46,47,57,76,72,73,76,77,75,76,77,81,72,73,81,85,75,76,85,87,10,11,87,93,10,11,93,99,10,11,99,105,10,11,105,118,10,11,118,121,10,11,121,125,10,11,125,138,10,11,138,141,10,11,75,76,10,11,141,142,131,132,142,143,75,76,143,146,10,11,75,76,146,157,46,47,157,174,125,126,174,178,10,11,75,76,10,11,178,179,125,126,174,175,179,184,137,138,10,11,75,76,184,186,10,11,186,188,10,11,188,192,10,11,192,193,163,164,193,194,125,126,194,196,154,156,196,198,10,11,75,76,198,199,10,11,199,203,10,11,203,209,10,11,209,212,10,11,212,215,10,11,215,219,10,11,219,243,10,11,243,254,10,11,254,257,10,11],"page/far_tiles.frag":[0,5,368,369,604,606,226,227,606,611,10,11],"page/image.frag":[0,5,837,839,821,822,674,675,226,227,839,842,10,11],"page/image.vert":[0,5,792,793,831,835,226,227,835,837,10,11],"page/none.frag":[0,5,257,259],"page/resolve.frag":[0,5,461,462,14,15,362,368,10,11,617,628,10,11,628,640,10,11,10,11,640,649,10,11,649,650,10,11,650,656,642,643,656,660,10,11,660,661,10,11,594,595,604,605,661,662,390,391,662,675,226,227,675,690,10,11,690,695,10,11,695,697,10,11],"page/screen.vert":[0,5,592,593],"page/segment.frag":[0,5,259,260,460,461,262,268,10,11,461,462,34,47,294,297,10,11,297,298,462,469,46,47,469,476,10,11,298,305,46,47,305,308,10,11,75,76,476,485,10,11,379,380,485,490,10,11,75,76,490,501,10,11,75,76,356,357,501,502,14,15,203,209,10,11,209,212,10,11,502,506,10,11,506,514,46,47,514,526,10,11,526,529,10,11,529,530,10,11,530,531,518,519,531,542,10,11,542,547,75,76,547,548,369,371,75,76,371,379,75,76,379,381,298,299,381,383,75,76,75,76,383,384,548,549,400,401,549,555,10,11,75,76,555,556,506,507,556,557,75,76,557,560,400,401,560,563,75,76,377,378,563,564,75,76,564,565,10,11,379,380,298,299,565,566,313,314,566,569,10,11,350,351,10,11,75,76,226,227,569,574,298,299,574,575,75,76,575,577,10,11,83,84,226,227,577,589,10,11,589,592,10,11,75,76],"page/segment.vert":[0,5,259,268,10,11,34,47,268,272,10,11,272,274,120,121,10,11,274,276,120,121,10,11,276,278,10,11,278,282,10,11,282,293,10,11,293,294,10,11,294,297,10,11,297,305,46,47,305,308,10,11,308,312,10,11,312,319,10,11,293,294,10,11,319,320,83,84,320,322,75,76,322,327,46,47,327,336,46,47,336,342,10,11,342,351,10,11,351,354,10,11,354,356,10,11,356,362,10,11,14,15,362,368,10,11,368,371,75,76,371,379,75,76,379,381,298,299,381,383,75,76,75,76,57,58,383,386,379,380,386,387,75,76,387,393,75,76,393,398,10,11,75,76,377,378,398,400,75,76,400,406,10,11,75,76,406,415,10,11,226,227,415,423,391,392,423,424,75,76,424,426,393,394,426,429,75,76,429,430,400,401,430,431,75,76,431,440,377,378,440,441,75,76,379,380,441,442,298,299,442,444,75,76,444,449,83,84,449,451,446,447,451,456,137,138,10,11,456,460,75,76,10,11],"page/surface.frag":[0,5,617,621,623,624,806,808,632,634,808,811,10,11,811,812,10,11,650,656,642,643,656,660,10,11,660,661,10,11,812,822,665,667,822,824,674,675,226,227,824,831,10,11],"page/surface.vert":[0,5,788,800,226,227,800,806,10,11],"page/tile_mask.frag":[0,5,593,596,226,227,596,603,10,11,603,604,10,11],"page/tiles.vert":[0,5,593,594,611,613,226,227,613,617,10,11],"page/visible_edges.frag":[0,5,265,268,10,11,476,477,478,479,594,595,604,605,697,705,10,11,226,227,705,711,10,11]}};var kt=Q.lines.split(`
`);function Bt(o){let e=[];for(let n=0;n<o.length;n+=2)e.push(...kt.slice(o[n],o[n+1]));return e.join(`
`)+`
`}var Fe={};for(let[o,e]of Object.entries(Q.shaders))Fe[o]=Bt(e);var ge=Q.blocks,Ze=Q.rotation_scales,se=Q.page_bits;function N(o){let e=atob(o),n=new Uint8Array(e.length);for(let t=0;t<e.length;++t)n[t]=e.charCodeAt(t);return n}var $e=N(Q.rotations),Lt=Q.fields;function P(o,e){let[,n,t]=Lt[o];return t===32?e:e>>>n&(1<<t)-1}var Z=(o,e)=>[o[0]-e[0],o[1]-e[1],o[2]-e[2]],q=(o,e,n=1)=>[o[0]+n*e[0],o[1]+n*e[1],o[2]+n*e[2]],$=(o,e)=>[o[0]*e,o[1]*e,o[2]*e],G=(o,e)=>o[0]*e[0]+o[1]*e[1]+o[2]*e[2],oe=(o,e)=>[o[1]*e[2]-o[2]*e[1],o[2]*e[0]-o[0]*e[2],o[0]*e[1]-o[1]*e[0]],et=o=>Math.hypot(o[0],o[1],o[2]),j=o=>$(o,1/(et(o)||1));function R(o,e){let n=new Float64Array(16);for(let t=0;t<4;++t)for(let r=0;r<4;++r){let s=0;for(let i=0;i<4;++i)s+=o[r+4*i]*e[i+4*t];n[r+4*t]=s}return n}function Ie(){let o=new Float64Array(16);return o[0]=o[5]=o[10]=o[15]=1,o}function ee(o){let e=Array.from({length:4},(t,r)=>Array.from({length:8},(s,i)=>i<4?o[r+4*i]:i-4===r?1:0));for(let t=0;t<4;++t){let r=t;for(let i=t+1;i<4;++i)Math.abs(e[i][t])>Math.abs(e[r][t])&&(r=i);if(!(Math.abs(e[r][t])>0))return null;[e[t],e[r]]=[e[r],e[t]];let s=e[t][t];for(let i=0;i<8;++i)e[t][i]/=s;for(let i=0;i<4;++i){if(i===t)continue;let a=e[i][t];for(let l=0;l<8;++l)e[i][l]-=a*e[t][l]}}let n=new Float64Array(16);for(let t=0;t<4;++t)for(let r=0;r<4;++r)n[t+4*r]=e[t][r+4];return n}function k(o,e,n=1){return[0,1,2,3].map(t=>o[t]*e[0]+o[t+4]*e[1]+o[t+8]*e[2]+o[t+12]*n)}function be(o){return[o[0],o[1],o[2],o[4],o[5],o[6],o[8],o[9],o[10]]}var ke=o=>new Float32Array(o);function ze(o,e,n){let t=n*Math.PI/180,r=Math.cos(t),s=Math.sin(t),i=j(e);return q(q($(o,r),oe(i,o),s),i,G(i,o)*(1-r))}var Re=class{constructor(e){h(this,"state",e)}get forward(){return j(Z(this.state.focal_point,this.state.position))}get right(){return j(oe(this.forward,this.state.up))}get distance(){return et(Z(this.state.focal_point,this.state.position))}view(){let e=this.forward,n=this.right,t=oe(n,e),r=this.state.position;return new Float64Array([n[0],t[0],-e[0],0,n[1],t[1],-e[1],0,n[2],t[2],-e[2],0,-G(n,r),-G(t,r),G(e,r),1])}range(e){let n=this.forward,t=this.state.position,r=1/0,s=-1/0;for(let a=0;a<8;++a){let l=G(n,Z([e[a&1],e[2+(a>>1&1)],e[4+(a>>2)]],t));r=Math.min(r,l),s=Math.max(s,l)}let i=Math.max(.005*(s-r),1e-6*Math.abs(s));return r-=i,s+=i,this.state.parallel?[r,Math.max(s,r+1e-6)]:(s=Math.max(s,1e-6),[Math.max(r,.001*s),s])}projection(e,n){let[t,r]=this.range(n),s=new Float64Array(16),i=this.state;if(i.parallel)s[0]=1/(i.parallel_scale*e),s[5]=1/i.parallel_scale,s[10]=-2/(r-t),s[14]=-(r+t)/(r-t),s[15]=1;else{let a=1/Math.tan(i.view_angle*Math.PI/360);s[0]=a/e,s[5]=a,s[10]=-(r+t)/(r-t),s[11]=-1,s[14]=-2*r*t/(r-t)}return s}rotate(e,n){let t=this.state,r=ze(Z(t.position,t.focal_point),t.up,-200*e),s=j(oe($(r,-1),t.up));r=ze(r,s,-200*n),t.position=q(t.focal_point,r),t.up=j(oe(s,j($(r,-1))))}roll(e){this.state.up=ze(this.state.up,this.forward,e)}pan(e,n){let t=this.state,r=t.parallel?2*t.parallel_scale:2*this.distance*Math.tan(t.view_angle*Math.PI/360),s=oe(this.right,this.forward),i=q($(this.right,-e*r),s,-n*r);t.position=q(t.position,i),t.focal_point=q(t.focal_point,i)}dolly(e){let n=this.state;n.parallel?n.parallel_scale/=e:n.position=q(n.focal_point,Z(n.position,n.focal_point),1/e)}lookAlong(e,n,t){let r=this.state,s=[(t[0]+t[1])/2,(t[2]+t[3])/2,(t[4]+t[5])/2],i=Math.hypot(t[1]-t[0],t[3]-t[2],t[5]-t[4])/2||1,a=i/Math.sin(r.view_angle*Math.PI/360);r.focal_point=s,r.position=q(s,j(e),-a),r.up=n,r.parallel_scale=i}};var Be=class{constructor(e,n){h(this,"lines",e);h(this,"base",n);h(this,"ranges",new Map);h(this,"regions",new Map);h(this,"hidden",new Set);h(this,"groups",[]);h(this,"chosen",null)}get count(){let e=this.chosen;return e?e.reduce((n,t)=>n+t,0):this.lines.set.streamlines}set(e,n,t,r){let s=this.ranges.get(e.name)??{values:n,low:e.range[0],high:e.range[1],whole:e.range};t===0?s.low=r:s.high=r,this.ranges.set(e.name,s),this.apply()}look(e,n){let{set:t,model:r}=this.lines,s=n?this.regions.get(e):void 0;this.regions.set(e,{through:t.through(e,r,s?.blocks,s?.through),blocks:t.blocks.length})}apply(){let e=[...this.ranges.values()].filter(i=>i.low>i.whole[0]||i.high<i.whole[1]),n=[...this.regions].filter(([i])=>i.on);if(!e.length&&!n.length&&!this.hidden.size)return this.keep(this.base);let t=this.lines.set.streamlines,r=new Uint8Array(t),s=this.grouped(t);for(let i=0;i<t;++i){let a=this.base===null||this.base[i]!==0;for(let l of e){let c=1e-6*(l.whole[1]-l.whole[0]);a=a&&l.values[i]>=l.low-c&&l.values[i]<=l.high+c}for(let[l,{through:c}]of n)a=a&&c[i]!==0!==l.inverted;r[i]=a&&s[i]?1:0}this.keep(r)}keep(e){this.chosen=e,this.lines.keep(e)}grouped(e){let n=new Uint8Array(e).fill(1);for(let t of this.hidden)for(let r of t)n[r]=0;for(let t of this.hidden.size?this.groups:[])if(!this.hidden.has(t))for(let r of t)n[r]=1;return n}};function tt(o,e,n,t){let r=new Float32Array(7*e);for(let s=0;s<e;++s){let i=4*n*s,a=t(s),l=i+4*(Math.min(a,n)-1),c=7*s,u=o[l]-o[i],f=o[l+1]-o[i+1],d=o[l+2]-o[i+2],p=u*u+f*f+d*d||1,g=0;for(let b=i+4;b<i+4*a;b+=4){let m=o[b]-o[i],v=o[b+1]-o[i+1],w=o[b+2]-o[i+2],I=Math.min(Math.max((m*u+v*f+w*d)/p,0),1),M=m-I*u,x=v-I*f,A=w-I*d;g=Math.max(g,M*M+x*x+A*A)}for(let b=0;b<3;++b)r[c+b]=o[i+b],r[c+3+b]=o[l+b];r[c+6]=1.0001*Math.sqrt(g)+1e-4}return r}function nt(o,e,n,t,r,s,i){let a=Float64Array.from(e),[l,c,u,f]=[0,1,2,3].map(m=>Math.hypot(a[m],a[m+4],a[m+8])),{size:d,columns:p,rows:g,depths:b}=s;for(let m=0,v=0;m<i.length;++m,v+=7){let w=o[v+6],I=1/0,M=-1/0,x=1/0,A=-1/0,L=1/0;for(let U=v;U<v+6;U+=3){let C=o[U],K=o[U+1],Y=o[U+2],ie=a[3]*C+a[7]*K+a[11]*Y+a[15],F=ie-w*f;if(!(F>0)){L=-1/0;break}let V=(a[0]*C+a[4]*K+a[8]*Y+a[12])/ie,pe=(a[1]*C+a[5]*K+a[9]*Y+a[13])/ie,Ee=w*(l+Math.abs(V)*f)/F+n,Te=w*(c+Math.abs(pe)*f)/F+n;V-Ee<I&&(I=V-Ee),V+Ee>M&&(M=V+Ee),pe-Te<x&&(x=pe-Te),pe+Te>A&&(A=pe+Te),L=Math.min(L,(a[2]*C+a[6]*K+a[10]*Y+a[14]-w*u)/F)}if(i[m]=1,L===-1/0)continue;if(M<0||I>t||A<0||x>r){i[m]=0;continue}let E=Math.max(Math.floor(I/d),0),_=Math.min(Math.floor(M/d),p-1),B=Math.max(Math.floor(x/d),0),S=Math.min(Math.floor(A/d),g-1);if((_-E+1)*(S-B+1)>256)continue;L-=1e-6;let D=!0;for(let U=B;U<=S&&D;++U)for(let C=E;C<=_;++C)if(L<=b[4*(U*p+C)]){D=!1;break}D&&(i[m]=0)}}function Ne({at:o,size:e},n){return[0,1,2].map(t=>(n[t]-o[t])/Math.max(e[t],1e-9))}function rt({ball:o},e,n){let t=Z(n,e);if(o){let i=Math.min(1,Math.max(0,-G(e,t)/(G(t,t)||1))),a=[e[0]+i*t[0],e[1]+i*t[1],e[2]+i*t[2]];return G(a,a)<=1}let r=0,s=1;for(let i=0;i<3;++i){if(t[i]===0){if(Math.abs(e[i])>1)return!1;continue}let a=(-1-e[i])/t[i],l=(1-e[i])/t[i];r=Math.max(r,Math.min(a,l)),s=Math.min(s,Math.max(a,l))}return r<=s}function it({ball:o,at:e,size:n}){let t=(s,i,a)=>[e[0]+s*n[0],e[1]+i*n[1],e[2]+a*n[2]];if(o){let s=Array.from({length:49},(i,a)=>[Math.cos(a*Math.PI/24),Math.sin(a*Math.PI/24)]);return[s.map(([i,a])=>t(i,a,0)),s.map(([i,a])=>t(i,0,a)),s.map(([i,a])=>t(0,i,a))]}let r=s=>[t(-1,-1,s),t(1,-1,s),t(1,1,s),t(-1,1,s),t(-1,-1,s)];return[r(-1),r(1),...[[-1,-1],[1,-1],[1,1],[-1,1]].map(([s,i])=>[t(s,i,-1),t(s,i,1)])]}var H=4096,ae=class extends Error{};function St(o,e){let n=e.includes("SPRITES")?Fe[o].replace("const bool SPRITES=false","const bool SPRITES=true"):Fe[o],t=e.find(r=>r.startsWith("REGION "));return(t?n.replace(/#define REGION .*/,`#define ${t}`):n).replace(/#define FEATURE_(\w+) [01]/g,(r,s)=>`#define FEATURE_${s} ${e.includes(s)?1:0}`)}var le=class{constructor(e,n,t,r=[],s=[]){h(this,"gl",e);h(this,"handle");h(this,"places",new Map);h(this,"units",new Map);this.handle=e.createProgram();let i=[[e.VERTEX_SHADER,n],[e.FRAGMENT_SHADER,t]].map(([a,l])=>{let c=e.createShader(a);return e.shaderSource(c,St(l,r)),e.compileShader(c),e.attachShader(this.handle,c),[l,c]});if(s.length&&e.transformFeedbackVaryings(this.handle,s,e.INTERLEAVED_ATTRIBS),e.linkProgram(this.handle),!e.getProgramParameter(this.handle,e.LINK_STATUS)&&!e.isContextLost()){let a=i.map(([l,c])=>`${l}: ${e.getShaderInfoLog(c)}`).join("; ");throw new ae(`This browser's graphics cannot run the page's programs: ${e.getProgramInfoLog(this.handle)} ${a}`)}Object.keys(ge).forEach((a,l)=>{let c=e.getUniformBlockIndex(this.handle,a);c!==e.INVALID_INDEX&&e.uniformBlockBinding(this.handle,c,l)})}use(){return this.gl.useProgram(this.handle),this}at(e){return this.places.has(e)||this.places.set(e,this.gl.getUniformLocation(this.handle,e)),this.places.get(e)}set(e){let n=this.gl;for(let[t,r]of Object.entries(e)){let s=this.at(t);s!==null&&(typeof r=="number"?n.uniform1f(s,r):r.length===2?n.uniform2fv(s,r):r.length===3?n.uniform3fv(s,r):r.length===4?n.uniform4fv(s,r):r.length===9?n.uniformMatrix3fv(s,!1,r):n.uniformMatrix4fv(s,!1,r))}return this}ints(e){for(let[n,t]of Object.entries(e)){let r=this.at(n);r!==null&&this.gl.uniform1i(r,t)}return this}uints(e){for(let[n,t]of Object.entries(e)){let r=this.at(n);r!==null&&this.gl.uniform1ui(r,t)}return this}textures(e){let n=this.gl;for(let[t,r]of Object.entries(e)){let s=this.at(t);if(s===null)continue;this.units.has(t)||this.units.set(t,this.units.size);let i=this.units.get(t);n.activeTexture(n.TEXTURE0+i),n.bindTexture(n.TEXTURE_2D,r),n.uniform1i(s,i)}return this}},Ge={r8ui:["R8UI","RED_INTEGER","UNSIGNED_BYTE",1,Uint8Array],r16ui:["R16UI","RED_INTEGER","UNSIGNED_SHORT",1,Uint16Array],r32ui:["R32UI","RED_INTEGER","UNSIGNED_INT",1,Uint32Array],rg32ui:["RG32UI","RG_INTEGER","UNSIGNED_INT",2,Uint32Array],rgba32ui:["RGBA32UI","RGBA_INTEGER","UNSIGNED_INT",4,Uint32Array],rgba8:["RGBA8","RGBA","UNSIGNED_BYTE",4,Uint8Array]};function st(o){for(let e of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])o.texParameteri(o.TEXTURE_2D,o[e],o.NEAREST);for(let e of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])o.texParameteri(o.TEXTURE_2D,o[e],o.CLAMP_TO_EDGE)}function ve(o,e,n,t){let[r]=Ge[e],s=Math.max(1,Math.ceil(n/H)),i=o.getParameter(o.MAX_TEXTURE_SIZE);if(s>i)throw new ae(`The ${t} have ${n} texels; this device's textures hold ${i*H}. Make a page of fewer streamlines.`);let a=o.createTexture();return o.bindTexture(o.TEXTURE_2D,a),st(o),o.texStorage2D(o.TEXTURE_2D,1,o[r],H,s),a}function ce(o,e,n,t,r,s){let[,i,a,l,c]=Ge[n],u=H*l,f=Math.floor(t.length/u),d=Math.ceil(s/H);o.bindTexture(o.TEXTURE_2D,e),o.pixelStorei(o.UNPACK_ALIGNMENT,1);for(let p=Math.floor(r/H);p<Math.min(f,d);p+=256){let g=Math.min(256,f-p,d-p);o.texSubImage2D(o.TEXTURE_2D,0,0,p,H,g,o[i],o[a],t.subarray(p*u,(p+g)*u))}if(d>f){let p=new c(u);p.set(t.subarray(f*u)),o.texSubImage2D(o.TEXTURE_2D,0,0,f,H,1,o[i],o[a],p)}}function X(o,e,n,t){let r=Math.ceil(n.length/Ge[e][3]),s=ve(o,e,r,t);return ce(o,s,e,n,0,r),s}function Le(o,e,n,t){let r=e.length/4-3,[s,i]=t?n.map(a=>Math.log10(a)):n;return[X(o,"rgba8",e,"colours"),[s,i,r/Math.max(i-s,1e-30),r]]}function te(o,e,n,t){let r=o.createTexture();return o.bindTexture(o.TEXTURE_2D,r),st(o),o.texStorage2D(o.TEXTURE_2D,1,e,n,t),r}function ne(o,e,n){let t=o.createFramebuffer();return o.bindFramebuffer(o.FRAMEBUFFER,t),o.framebufferTexture2D(o.FRAMEBUFFER,o.COLOR_ATTACHMENT0,o.TEXTURE_2D,e,0),n&&o.framebufferTexture2D(o.FRAMEBUFFER,o.DEPTH_ATTACHMENT,o.TEXTURE_2D,n,0),t}var O=class{constructor(e,n){h(this,"gl",e);h(this,"name",n);h(this,"bytes");h(this,"floats");h(this,"words");h(this,"buffer");h(this,"binding");this.bytes=new ArrayBuffer(ge[n].bytes),this.floats=new Float32Array(this.bytes),this.words=new Uint32Array(this.bytes),this.buffer=e.createBuffer(),this.binding=Object.keys(ge).indexOf(n),e.bindBuffer(e.UNIFORM_BUFFER,this.buffer),e.bufferData(e.UNIFORM_BUFFER,this.bytes.byteLength,e.DYNAMIC_DRAW)}write(e,n=[]){for(let[t,r]of Object.entries(e)){let s=ge[this.name].fields[t]/4,i=n.includes(t)?this.words:this.floats;typeof r=="number"?i[s]=r:i.set(r,s)}this.upload()}fill(e){new Uint8Array(this.bytes).set(e),this.upload()}upload(){this.gl.bindBuffer(this.gl.UNIFORM_BUFFER,this.buffer),this.gl.bufferSubData(this.gl.UNIFORM_BUFFER,0,new Uint8Array(this.bytes))}bind(){this.gl.bindBufferBase(this.gl.UNIFORM_BUFFER,this.binding,this.buffer)}};var Mt=1024,we=16,Dt=16,Ut=.1,Ct=[4,8,11,15],ot=0,Pt=3;function at(o,e,n,t){if(!o||!(o.data instanceof Uint32Array)||o.data.length!==n*t)throw new T(`The file's ${e} do not fit its header. Copy or make it again.`);return o.data}function ue(o){let e=Math.ceil(o.byteLength/4);if(o.byteOffset%4===0&&o.byteOffset+4*e<=o.buffer.byteLength)return new Uint32Array(o.buffer,o.byteOffset,e);let n=new Uint8Array(4*e);return n.set(new Uint8Array(o.buffer,o.byteOffset,o.byteLength)),new Uint32Array(n.buffer)}function lt(o,e){return e===8?o:new Uint16Array(o.slice().buffer)}var Se=class{constructor(e,n){h(this,"gl",e);h(this,"archive",n);h(this,"blocks",[]);h(this,"streamlines");h(this,"points");h(this,"bounds");h(this,"reference");h(this,"toData");h(this,"coding");h(this,"budget",256<<20);h(this,"parameters");h(this,"decodeProgram",null);h(this,"rotationBlock");h(this,"frameForDecoding");h(this,"textures",{});h(this,"itemBuffer");h(this,"toItems");h(this,"feedback");h(this,"scratch",null);h(this,"scratchBytes",0);h(this,"share",15);h(this,"itemBytes",15*we);h(this,"kinds",new Set);h(this,"table");h(this,"done",0);h(this,"shares",0);h(this,"before",0);h(this,"open",null);h(this,"growing",{});h(this,"values",[]);h(this,"held",0);h(this,"clock",0);h(this,"fiblets");h(this,"decodeArray");h(this,"indices",null);h(this,"arrays",[null,null]);let{header:t,arrays:r}=n;if(t.format!=="fiblets")throw new T("The file is no .fiblets file: its header says something else.");if(t.version!==2)throw new T(`The file is of version ${t.version}; this page reads version 2. Make the page again with a newer pvfiblets.`);let s=this.parameters=t.parameters,i=this.fiblets=t.n_fiblets;this.streamlines=t.n_streamlines,this.points=t.n_points,this.bounds=t.bounds;let a=at(r.get("anchors.npy"),"anchors",2,i),l=at(r.get("decoding.npy"),"records",3,i),c=r.get("codes.npy"),u=r.get("pages.npy");if(!c||!(c.data instanceof Uint8Array)||!u||!(u.data instanceof BigInt64Array))throw new T("The file's codes or pages are missing. Copy or make it again.");let f=this.table=Array.from(u.data,Number),d=Math.ceil(i/(1<<se));if(f.length!==3*(d+1)||f[3*d+1]!==c.data.length||f[3*d+2]!==this.points)throw new T("The file's table of pages does not fit its records. Copy or make it again.");let p=s.anchor_bits===32?r.get("anchors_low.npy"):void 0;if(s.anchor_bits===32&&!(p?.data instanceof Uint16Array&&p.data.length===3*i))throw new T("The lower halves of the file's anchors are missing. Copy or make it again.");let g=s.anchor_bits===32?4294967295:65535;this.reference=[0,1,2].map(m=>{let v=(this.bounds[2*m]+this.bounds[2*m+1])/2,w=s.anchor_scale[m];return w>0&&Number.isFinite(v)?Math.round(Math.min(Math.max((v-s.origin[m])/w,0),g)):0}),this.toData=new Float64Array([1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]);for(let m=0;m<3;++m)this.toData[12+m]=s.origin[m]+s.anchor_scale[m]*this.reference[m];this.grow("anchor_texels","rg32ui",a,"anchors"),this.grow("decoding_texels","r32ui",l,"records"),this.grow("code_texels","r32ui",ue(c.data),"codes"),p&&this.grow("anchor_low_texels","r32ui",ue(p.data),"anchors");let b=new Uint32Array(4*Math.max(d,1));for(let m=0;m<d;++m)for(let v=0;v<3;++v)b[4*m+v]=f[3*m+v];this.textures.page_texels=X(e,"rgba32ui",b,"pages"),this.coding=new O(e,"Coding"),this.coding.write({anchor_scale:s.anchor_scale,radius_scale:0,step_low:s.step_lo,step_span:s.step_hi-s.step_lo,lattice_edge:s.lattice,end_vector_scale:0,rotation_scales:Ze}),this.rotationBlock=new O(e,"Rotations"),this.rotationBlock.fill($e),this.frameForDecoding=new O(e,"Frame"),this.frameForDecoding.write({reference:this.reference},["reference"]),this.feedback=e.createTransformFeedback(),this.decodeArray=e.createVertexArray(),e.bindVertexArray(this.decodeArray),e.enableVertexAttribArray(0),e.bindVertexArray(null)}grow(e,n,t,r){let s=this.textures[e]=ve(this.gl,n,n==="rg32ui"?t.length/2:t.length,r);this.growing[e]={texture:s,format:n,data:t}}fill(e,n,t){let r=this.growing[e];r&&ce(this.gl,r.texture,r.format,r.data,n,t)}sharesOf(e,n=this.share){let t=P("last",this.growing.decoding_texels.data[3*e+2])+1,r=this.growing.anchor_texels.data[2*e+1]>>>31;return t%n===0&&!r?t/n:Math.ceil((t+(r?1:2))/n)}begin(e){let n=this.gl,r=Ct.map(l=>{let c=0,u=0;for(let f=0;f<e;++f){let d=this.sharesOf(f,l);c+=d*l*(1+.05*d),u+=d}return{share:l,cost:c,total:u}}).reduce((l,c)=>c.cost<l.cost?c:l),s=this.fiblets-e;this.share=r.share,this.itemBytes=this.share*we;let i=this.points;for(let l=0;l<e;++l)i-=P("last",this.growing.decoding_texels.data[3*l+2])+1;let a=Math.max(r.total+Math.floor((Math.max(i,0)+(this.share+1)*s)/this.share),1);this.toItems=new Uint32Array(4*a),this.textures.items=ve(n,"rgba32ui",a,"shares of fiblets"),this.itemBuffer=n.createBuffer(),n.bindBuffer(n.ARRAY_BUFFER,this.itemBuffer),n.bufferData(n.ARRAY_BUFFER,8*a,n.STATIC_DRAW)}advance(e){let n=this.gl,t=this.done,r=Math.min(e,this.fiblets),s=this.parameters,{table:i}=this;if(r<=t&&this.fiblets)return;t||this.begin(r);let a=this.archive.arrays.get("rank_to_id.npy")?.data,l=this.archive.arrays.get("anchors_low.npy")?.data,c=this.growing.anchor_texels.data,u=this.growing.decoding_texels.data,f=this.toItems,d=i[i.length-2],p=this.shares,g=2*s.largest_radius,b=this.kinds.size,m=p,v=this.open,w=0;for(let x=t;x<r;++x)w+=this.sharesOf(x);let I=new Uint32Array(2*w),M=()=>{v&&(v.more=1,this.blocks.push(v))};for(let x=t;x<r;++x){let A=3*(x>>se),L=c[2*x+1],E=u[3*x+2],_=P("rank",L)+i[A],B=P("last",E)+1,S=a?Number(a[_]):_,D=P("begin",L),U=P("end",L),C=P("code",u[3*x+1])+i[A+1],K=P("point",E)+i[A+2],Y=this.sharesOf(x);if(B>60||4*(m+Y)>f.length||!(S>=0&&S<this.streamlines)||C>d||K+B>this.points)throw new T(`Record ${x} of the file is damaged. Copy or make it again.`);this.kinds.add(P("kind",E)),x%Mt===0&&(M(),v={firstItem:m,items:0,more:0,bounds:[1/0,-1/0,1/0,-1/0,1/0,-1/0],buffer:null,used:0,shapes:null,likely:null,likelies:0});let ie=[c[2*x]&65535,c[2*x]>>>16,L&65535];for(let F=0;F<3;++F){let V=s.origin[F]+s.anchor_scale[F]*(l?ie[F]*65536+l[3*x+F]:ie[F]);v.bounds[2*F]=Math.min(v.bounds[2*F],V-g),v.bounds[2*F+1]=Math.max(v.bounds[2*F+1],V+g)}D&&(this.before=0);for(let F=0;F<Y;++F,++m)f[4*m]=S,f[4*m+1]=K,f[4*m+2]=B|D<<6|U<<7|F<<8,f[4*m+3]=this.before,I[2*(m-p)]=x,I[2*(m-p)+1]=F;this.before+=B,v.items+=Y}this.open=v,r===this.fiblets&&v&&this.blocks.push(v),this.shares=m,this.done=r,this.kinds.size>b&&(this.decodeProgram=null),ce(n,this.textures.items,"rgba32ui",f,p,m),n.bindBuffer(n.ARRAY_BUFFER,this.itemBuffer),n.bufferSubData(n.ARRAY_BUFFER,8*p,I),this.fill("anchor_texels",t,r),this.fill("decoding_texels",3*t,3*r),this.fill("anchor_low_texels",Math.floor(1.5*t),Math.ceil(1.5*r)),this.fill("code_texels",this.countBefore(t,1)>>2,this.countBefore(r,1)+3>>2);for(let{texture:x,format:A,data:L}of this.values)ce(n,x,A,L,this.countBefore(t,2),this.countBefore(r,2))}countBefore(e,n){return this.table[3*Math.ceil(e/(1<<se))+n]}pointValues(e){let n=this.archive.header.per_point?.[e],t=n&&this.archive.arrays.get(n.member);if(!t||t.data.length!==this.points)throw new T(`The file has no values ${e} for its points.`);return this.codedValues(e,t.data,n)}codedValues(e,n,{lo:t,hi:r}){if(n.length!==this.points)throw new T(`The values ${e} are not those of the file's points.`);let s=n instanceof Uint16Array,i=s?65535:255,a=s?"r16ui":"r8ui",l=ve(this.gl,a,this.points,"values of points");return this.values.push({texture:l,format:a,data:n}),ce(this.gl,l,a,n,0,this.countBefore(this.done,2)),{name:e,texture:l,code:[t,(r-t)/(i-1),i]}}forget({texture:e}){this.values=this.values.filter(n=>n.texture!==e),this.gl.deleteTexture(e)}decoder(){let e=["DIRECTION"];return this.textures.anchor_low_texels&&e.push("ANCHORS_LOW"),(this.kinds.size>1||!this.kinds.has(ot))&&e.push("LATTICE"),this.kinds.has(Pt)&&e.push("WIDE_LATTICE"),this.decodeProgram??(this.decodeProgram=new le(this.gl,"page/decode.vert","page/none.frag",e,Array.from({length:this.share},(n,t)=>`o${t}`)))}decode(e,n){let t=this.gl,r=e.items+e.more;this.coding.bind(),this.rotationBlock.bind(),this.frameForDecoding.bind();let{items:s,...i}=this.textures;this.decoder().use().textures(i).uints({chunk_fiblets:this.fiblets,share_size:this.share}),t.bindVertexArray(this.decodeArray),t.bindBuffer(t.ARRAY_BUFFER,this.itemBuffer),t.vertexAttribIPointer(0,2,t.UNSIGNED_INT,8,8*e.firstItem),t.bindBuffer(t.ARRAY_BUFFER,null),t.enable(t.RASTERIZER_DISCARD),t.bindTransformFeedback(t.TRANSFORM_FEEDBACK,this.feedback),t.bindBufferRange(t.TRANSFORM_FEEDBACK_BUFFER,0,n,0,r*this.itemBytes),t.beginTransformFeedback(t.POINTS),t.drawArrays(t.POINTS,0,r),t.endTransformFeedback(),t.bindBufferBase(t.TRANSFORM_FEEDBACK_BUFFER,0,null),t.bindTransformFeedback(t.TRANSFORM_FEEDBACK,null),t.disable(t.RASTERIZER_DISCARD),t.bindVertexArray(null)}size(e){return(e.items+e.more)*this.itemBytes+2*we}newBuffer(e){let n=this.gl,t=n.createBuffer();return n.bindBuffer(n.ARRAY_BUFFER,t),n.bufferData(n.ARRAY_BUFFER,e,n.DYNAMIC_COPY),n.bindBuffer(n.ARRAY_BUFFER,null),t}pointsOf(e){if(e.used=++this.clock,e.buffer)return e.buffer;let n=this.size(e);return this.held+n<=this.budget?(this.held+=n,e.buffer=this.newBuffer(n),this.decode(e,e.buffer),e.buffer):(this.scratchBytes<n&&(this.scratch&&this.gl.deleteBuffer(this.scratch),this.scratch=this.newBuffer(this.scratchBytes=n)),this.decode(e,this.scratch),this.scratch)}get items(){return this.textures.items}segments(e){return e*this.share}get longestStep(){return this.kinds.size===1&&this.kinds.has(ot)?2*this.parameters.step_hi:1/0}draw(e,n,t,r){return this.drawRun(e,n,0,Math.max(1,Math.round(t)),r)}drawRun(e,n,t,r,s){let i=this.gl,a=(r-t)*this.share;return this.aim(e,n,t,s),s?i.drawArrays(i.POINTS,0,a):i.drawArraysInstanced(i.TRIANGLE_STRIP,0,4,a),i.bindVertexArray(null),a}aim(e,n,t,r){let s=this.gl,i=this.pointsOf(e);n.use().ints({first_item:e.firstItem+t,share_size:this.share}),s.bindVertexArray(this.segmentArray(r)),s.bindBuffer(s.ARRAY_BUFFER,i);for(let a=0;a<3;++a)s.vertexAttribIPointer(a,4,s.UNSIGNED_INT,we,t*this.itemBytes+a*we)}likely(e){return e.likely||(e.likely=new Uint8Array(e.items).fill(1,0,e.likelies=Math.max(1,Math.round(Ut*e.items)))),e.likely}look(e,n,t,r,s,i){let a=new Uint8Array(e.items),l=this.likely(e),c=new Uint8Array(e.items);nt(e.shapes??(e.shapes=this.shapesOf(e)),n,t,r,s,i,a),e.likelies=0;for(let u=0;u<c.length;++u)c[u]=a[u]&~l[u],e.likelies+=a[u];return e.likely=a,c}shapesOf(e){let n=this.toItems,{share:t}=this;return tt(this.slotsOf(e),e.items,t,r=>{let s=n[4*(e.firstItem+r)+2],i=s>>>7&1,a=s&63;return Math.min(a+1-i-t*(s>>>8),t+1)})}slotsOf(e){let n=this.gl,t=new Float32Array((e.items+e.more+1)*this.share*4);return n.bindBuffer(n.ARRAY_BUFFER,this.pointsOf(e)),n.getBufferSubData(n.ARRAY_BUFFER,0,t,0,(e.items+e.more)*this.share*4),n.bindBuffer(n.ARRAY_BUFFER,null),t}drawSome(e,n,t,r,s=1/0){let i=this.gl,{share:a}=this,l=0;if(!r){let f=0,d=0;for(let p=0;p<t.length&&d<s;++p){if(!t[p])continue;let g=p+1;++d;for(let b=g;b<Math.min(t.length,g+Dt)&&d<s;++b)t[b]&&(g=b+1,++d);f+=this.drawRun(e,n,p,g,r),p=g}return f}let c=Math.min(s,t.length),u=new Uint32Array(c*a);for(let f=0,d=0;f<t.length&&d<c;++f){if(!t[f])continue;let p=this.toItems[4*(e.firstItem+f)+2],g=p&63,b=g-((p&128)!==0&&g>1?1:0);for(let m=f*a,v=m+Math.min(b-a*(p>>>8),a);m<v;++m)u[l++]=m;++d}return l?(this.aim(e,n,0,r),i.bindBuffer(i.ELEMENT_ARRAY_BUFFER,this.indices??(this.indices=i.createBuffer())),i.bufferData(i.ELEMENT_ARRAY_BUFFER,u.subarray(0,l),i.STREAM_DRAW),i.drawElements(i.POINTS,l,i.UNSIGNED_INT,0),i.bindVertexArray(null),l):0}segmentArray(e){let n=e?1:0;if(!this.arrays[n]){let t=this.gl;t.bindVertexArray(this.arrays[n]=t.createVertexArray());for(let r=0;r<3;++r)t.enableVertexAttribArray(r),t.vertexAttribDivisor(r,e?0:1)}return this.arrays[n]}*decoded(e,n=0){let t=this.toItems;for(let r of this.blocks.slice(n)){if(!e(r))continue;let s=this.slotsOf(r);for(let i=r.firstItem;i<r.firstItem+r.items;++i){if(t[4*i+2]>>>8)continue;let a=t[4*i+2]&63,l=(t[4*i+2]&128)!==0,c=4*this.share*(i-r.firstItem);yield[t[4*i],s.subarray(c,c+4*(a+(l?0:1))),(t[4*i+2]&64)!==0]}}}blocksOf(e){let n=this.toItems;return t=>{for(let r=t.firstItem;r<t.firstItem+t.items;++r)if(n[4*r]===e)return!0;return!1}}world(e,n){return[0,1,2].map(t=>this.toData[12+t]+e[4*n+t])}pointsOfStreamline(e){let n=[];for(let[t,r]of this.decoded(this.blocksOf(e)))if(t===e)for(let s=0;4*s<r.length;++s)n.push(this.world(r,s));return n}through(e,n,t=0,r=new Uint8Array(this.streamlines)){let{at:s,size:i}=e,a=({bounds:l})=>{let c=[0,1,2,3,4,5,6,7].map(u=>k(n,[l[u&1],l[2+(u>>1&1)],l[4+(u>>2)]]));return[0,1,2].every(u=>c.some(f=>f[u]>=s[u]-i[u])&&c.some(f=>f[u]<=s[u]+i[u]))};for(let[l,c]of this.decoded(a,t)){if(r[l])continue;let u=Ne(e,k(n,this.world(c,0)));for(let f=0;f<c.length&&!r[l];f+=4){let d=Ne(e,k(n,this.world(c,Math.min(f+4,c.length-4)/4)));rt(e,u,d)&&(r[l]=1),u=d}}return r}release(){let e=this.gl;for(let n of this.blocks)n.buffer&&e.deleteBuffer(n.buffer);for(let n of Object.values(this.textures))e.deleteTexture(n);for(let n of[this.scratch,this.indices,this.itemBuffer])n&&e.deleteBuffer(n)}};var ct="http://www.w3.org/2000/svg";function y(o,e={},...n){let t=document.createElement(o);for(let[r,s]of Object.entries(e))t.setAttribute(r,s);return t.append(...n),t}var W=o=>Number.isFinite(o)?String(Number(o.toPrecision(4))):"no value";function z(o,e,n,t,r){let s=(n-e)/200||1,i=y("output",{},W(t)),a=y("input",{type:"range",min:String(e),max:String(n),step:String(s),value:String(t)});return a.addEventListener("input",()=>{i.textContent=W(a.valueAsNumber),r(a.valueAsNumber)}),y("label",{},y("span",{},o),a,i)}function Me(o,e,n){let t=y("input",{type:"checkbox"});return t.checked=e,t.addEventListener("change",()=>n(t.checked)),y("label",{},t,y("span",{},o))}function fe(o,e){let n=y("button",{type:"button"},o);return n.addEventListener("click",e),n}function re(o,...e){return y("fieldset",{},y("legend",{},o),...e)}var Ot=[["Left",[1,0,0],[0,0,1]],["Right",[-1,0,0],[0,0,1]],["Front",[0,-1,0],[0,0,1]],["Back",[0,1,0],[0,0,1]],["Top",[0,0,-1],[0,1,0]],["Bottom",[0,0,1],[0,1,0]]];function zt(o){let e=N(o.table),n=e.length/4,t=y("canvas",{width:String(n),height:"1",role:"img","aria-label":`Colours from ${W(o.clim[0])} to ${W(o.clim[1])}`}),r=t.getContext("2d"),s=r.createImageData(n,1);if(s.data.set(e),r.putImageData(s,0,0),o.labels){let c=o.labels.map(({name:u,colour:f})=>{let d=y("i",{"aria-hidden":"true"});return d.style.background=`rgb(${f.join(",")})`,y("li",{},d,u)});return y("figure",{class:"bar"},y("figcaption",{},o.title),y("ul",{tabindex:"0","aria-label":o.title},...c))}let[i,a]=o.clim,l=o.log?Math.sqrt(i*a):(i+a)/2;return y("figure",{class:"bar"},y("figcaption",{},o.title),t,y("div",{class:"ticks","aria-hidden":"true"},...[i,l,a].map(c=>y("span",{},W(c)))))}var De=class{constructor(e,n){h(this,"renderer",e);h(this,"data",n);h(this,"told",null);h(this,"status",document.getElementById("status"));h(this,"axes",[]);h(this,"choices",new Map);h(this,"picked",null);h(this,"regions",[]);h(this,"outlines",document.createElementNS(ct,"svg"));h(this,"later",0);let t=document.getElementById("over"),{scene:r}=e,s=y("details",{id:"panel"},y("summary",{},"Scene"));s.append(this.layers(),...this.groups(),this.views(),this.cut(),...this.ranges(),this.regionList()),t.append(this.outlines,s),r.bars.length&&t.append(y("div",{id:"bars"},...r.bars.map(zt))),t.append(this.orientation()),e.restored=()=>{for(let i of this.choices.values())i.apply()},e.presented=()=>this.follow(),e.grown=()=>this.grown(),this.follow()}layers(){let{renderer:e}=this,n=[];return e.scene.layers.forEach(t=>{n.push(Me(t.name,t.visible,r=>{t.visible=r,e.change()})),t.kind==="fiblets"?n.push(z("Line width",.5,10,t.line_width,r=>{t.line_width=r,e.change(!0)})):n.push(z("Opacity",0,1,t.opacity,r=>{t.opacity=r,e.change(!0)}))}),re("Shown",...n)}views(){let{renderer:e}=this,n=structuredClone(e.camera.state),t=Ot.map(([r,s,i])=>fe(r,()=>{e.camera.lookAlong(s,i,e.scene.bounds),e.change()}));return t.push(fe("As at first",()=>{Object.assign(e.camera.state,structuredClone(n)),e.change()})),t.push(fe("Save picture",()=>this.save())),re("View",y("div",{class:"buttons"},...t))}save(){let{renderer:e}=this;e.settled().then(()=>{let n=y("canvas",{width:String(e.width),height:String(e.height)}),t=n.getContext("2d"),r=t.createImageData(e.width,e.height);r.data.set(e.pixels()),t.putImageData(r,0,0),n.toBlob(s=>{let i=y("a",{href:URL.createObjectURL(s),download:"picture.png"});i.click(),setTimeout(()=>URL.revokeObjectURL(i.href),6e4)})})}cut(){let{renderer:e}=this,n=e.scene.bounds,t=y("select",{"aria-label":"Cut across"});for(let l of["nothing","left to right","back to front","bottom to top"])t.append(y("option",{},l));let r=y("div"),s=0,i=0,a=()=>{let l=t.selectedIndex-1,c=u=>[0,1,2].map(f=>f===l?u:0).concat(-u*s+i/2);e.planes=l<0?[]:[c(1),c(-1)],e.change(!0)};return t.addEventListener("change",()=>{let l=t.selectedIndex-1;if(r.replaceChildren(),l>=0){let c=n[2*l],u=n[2*l+1];s=(c+u)/2,i=(u-c)/8,r.append(z("Middle",c,u,s,f=>{s=f,a()}),z("Thickness",(u-c)/200,u-c,i,f=>{i=f,a()}))}a()}),re("Slab across",t,r)}choiceOf(e){let n=this.choices.get(e.index);return n||this.choices.set(e.index,n=new Be(e,e.layer.kept===void 0?null:this.data[e.layer.kept])),n}ranges(){let{renderer:e}=this,n=[];for(let t of e.lines){let{values:r,layer:s}=t;if(r){let i=r.code[0],a=i+r.code[1]*(r.code[2]-1),l=[i,a],c=()=>{e.lines[t.index].shownValues=l[0]>i||l[1]<a?[l[0],l[1]]:[1,0],e.change(!0)};n.push(re(r.name,z("From",i,a,i,u=>{l[0]=u,c()}),z("To",i,a,a,u=>{l[1]=u,c()})))}for(let i of s.controls??[]){if(i.data===void 0)continue;let a=this.data[i.data],l=new Float32Array(a.slice().buffer),[c,u]=i.range,f=d=>p=>{this.choiceOf(e.lines[t.index]).set(i,l,d,p),e.change(!0)};n.push(re(i.name,z("From",c,u,c,f(0)),z("To",c,u,u,f(1))))}}return n}groups(){return this.renderer.lines.filter(({layer:e})=>e.groups?.length).map(e=>{let n=this.choiceOf(e),t=e.layer.groups.map(({name:r,data:s})=>{let i=ue(this.data[s]);return n.groups.push(i),Me(r,!0,a=>{a?n.hidden.delete(i):n.hidden.add(i),n.apply(),this.renderer.change()})});return re(`Groups of ${e.layer.name}`,...t)})}regionList(){let e=y("div"),{renderer:n}=this,t=n.scene.bounds,r=Math.hypot(t[1]-t[0],t[3]-t[2],t[5]-t[4]),s=i=>()=>{let a=this.picked?k(this.picked.lines.model,this.picked.place).slice(0,3):[0,1,2].map(c=>(t[2*c]+t[2*c+1])/2),l={ball:i,at:a,size:[r/40,r/40,r/40],on:!0,inverted:!1};this.regions.push(l),e.append(this.regionRow(l,r)),this.update(l)};return re("Regions",y("div",{class:"buttons"},fe("Add a ball",s(!0)),fe("Add a box",s(!1))),e)}regionRow(e,n){let{renderer:t}=this,r=t.scene.bounds,s=`${e.ball?"Ball":"Box"} ${this.regions.length}`,i=()=>{window.clearTimeout(this.later),this.later=window.setTimeout(()=>this.update(e),120),this.drawOutlines()},a=(c,u)=>z(c,n/1e3,n/4,e.size[u[0]],f=>{for(let d of u)e.size[d]=f;i()}),l=y("details",{},y("summary",{},s),Me("On",!0,c=>{e.on=c,this.choose()}),Me("Streamlines outside it",!1,c=>{e.inverted=c,this.choose()}),...["x","y","z"].map((c,u)=>z(`${c}, mm`,r[2*u],r[2*u+1],e.at[u],f=>{e.at[u]=f,i()})),...e.ball?[a("Radius, mm",[0,1,2])]:["x","y","z"].map((c,u)=>a(`Half of ${c}, mm`,[u])),y("div",{class:"buttons"},fe(`Remove ${s.toLowerCase()}`,()=>{l.remove(),this.regions.splice(this.regions.indexOf(e),1);for(let c of this.choices.values())c.regions.delete(e);this.choose()})));return l.open=!0,l}update(e){if(this.regions.includes(e)){for(let n of this.renderer.lines)this.choiceOf(n).look(e,!1);this.choose()}}grown(){if(this.regions.length){for(let e of this.choices.values())for(let n of this.regions)e.look(n,!0);this.choose()}}choose(){let e=0;this.drawOutlines();for(let n of this.choices.values())n.apply(),e+=n.count;this.status.textContent=this.regions.some(n=>n.on)?`${e} streamlines are shown`:"",this.renderer.change()}pick(e,n){let{renderer:t}=this,r=t.pick(e,n);if(this.unmark(),r){let{lines:s,streamline:i,value:a}=r,l=t.placeOf(s,i,e,n),c=k(s.model,l).slice(0,3);this.say(s,i,a,c),this.picked={lines:s,streamline:i,place:l},this.told?.({layer:t.scene.layers.indexOf(s.layer),streamline:i,place:c})}else this.told?.(null);t.change()}mark(e){this.unmark();let n=e&&this.renderer.lines.find(({layer:t})=>t===this.renderer.scene.layers[e.layer]);if(e&&n&&e.streamline>=0&&e.streamline<n.set.streamlines){let{streamline:t}=e,r=n.set.pointsOfStreamline(t),s=r[r.length>>1];this.say(n,t,null,e.place??[]),s&&(this.picked={lines:n,streamline:t,place:s})}this.renderer.change()}unmark(){for(let e of this.renderer.lines)e.marked=4294967295;this.picked=null,this.status.textContent=""}say(e,n,t,r){e.marked=n;let s=[`Streamline ${n} of ${e.layer.name}`];t!==null&&e.values&&s.push(`${e.values.name} ${W(t)}`);for(let i of e.layer.controls??[])i.data!==void 0&&s.push(`${i.name} ${W(new Float32Array(this.data[i.data].slice().buffer)[n])}`);r.length&&s.push(`at ${r.map(W).join(", ")} mm`),this.status.textContent=s.join("; ")}orientation(){let n=(this.renderer.scene.letters?[["L","R"],["P","A"],["I","S"]]:[["","x"],["","y"],["","z"]]).flat().map((t,r)=>y("span",{class:`axis a${r>>1}`},t));return this.axes=n,y("div",{id:"axes","aria-hidden":"true"},...n)}follow(){this.turnAxes(),this.drawOutlines()}drawOutlines(){let{renderer:e,outlines:n}=this,{camera:t,canvas:r}=e,s=r.clientWidth,i=r.clientHeight;if(!this.regions.length)return n.replaceChildren();let a=R(t.projection(s/i,e.scene.bounds),t.view());n.replaceChildren(...this.regions.map(l=>{let c=document.createElementNS(ct,"path"),u=[];for(let f of it(l)){let d="M";for(let p of f){let[g,b,,m]=k(a,p);m>0&&u.push(`${d}${((g/m+1)*s/2).toFixed(1)} ${((1-b/m)*i/2).toFixed(1)}`),d=m>0?"L":"M"}}return c.setAttribute("d",u.join("")),c.setAttribute("opacity",l.on?"1":".3"),c}))}turnAxes(){let e=this.renderer.camera.view();this.axes.forEach((n,t)=>{let r=$([0,1,2].map(l=>l===t>>1?1:0),t&1?1:-1),[s,i,a]=k(e,r,0);n.style.transform=`translate(${(s*32).toFixed(1)}px, ${(-i*32).toFixed(1)}px)`,n.style.opacity=String(.35+.65*(.5+a/2))})}};function Ye(o,e=()=>{}){let{canvas:n,camera:t}=o,r=new Map,s=0,i=0;n.addEventListener("pointerdown",l=>{n.focus(),n.setPointerCapture(l.pointerId),r.set(l.pointerId,{x:l.offsetX,y:l.offsetY}),s=0,i=l.button,l.preventDefault()}),n.addEventListener("contextmenu",l=>l.preventDefault());let a=l=>{r.delete(l.pointerId)&&(l.type==="pointerup"&&s<4&&i===0&&!r.size?e(l.offsetX,l.offsetY):o.change())};n.addEventListener("pointerup",a),n.addEventListener("pointercancel",a),n.addEventListener("pointermove",l=>{let c=r.get(l.pointerId);if(!c)return;let u=l.offsetX-c.x,f=l.offsetY-c.y,d=n.clientWidth,p=n.clientHeight;if(s+=Math.abs(u)+Math.abs(f),r.size===2){let g=[...r.entries()].find(([v])=>v!==l.pointerId)[1],b=[c.x-g.x,c.y-g.y],m=[l.offsetX-g.x,l.offsetY-g.y];t.dolly(Math.hypot(m[0],m[1])/Math.max(1,Math.hypot(b[0],b[1]))),t.roll((Math.atan2(m[1],m[0])-Math.atan2(b[1],b[0]))*180/Math.PI),t.pan(u/2/p,-f/2/p)}else i===1||l.shiftKey?t.pan(u/p,-f/p):i===2?t.dolly(Math.pow(1.1,-20*.2*f/(p/2)*5)):l.ctrlKey?t.roll(180*u/d):t.rotate(u/d,-f/p);c.x=l.offsetX,c.y=l.offsetY,o.change(!0)}),n.addEventListener("wheel",l=>{t.dolly(Math.pow(1.1,Math.max(-3,Math.min(3,-l.deltaY/50)))),o.change(!0),l.preventDefault()},{passive:!1}),n.addEventListener("keydown",l=>{let u={ArrowLeft:()=>l.shiftKey?t.pan(-.04,0):t.rotate(-.04,0),ArrowRight:()=>l.shiftKey?t.pan(.04,0):t.rotate(.04,0),ArrowUp:()=>l.shiftKey?t.pan(0,.04):t.rotate(0,.04),ArrowDown:()=>l.shiftKey?t.pan(0,-.04):t.rotate(0,-.04),"+":()=>t.dolly(1.1),"=":()=>t.dolly(1.1),"-":()=>t.dolly(.9090909090909091),Enter:()=>e(n.clientWidth/2,n.clientHeight/2)};l.altKey||l.metaKey||!u[l.key]||(u[l.key](),o.change(!0),l.preventDefault())})}var Ve=o=>Array.isArray(o)&&o.length===3&&o.every(Number.isFinite);function ut(o,e){let{parent:n}=window;if(n===window)return;let t=i=>n.postMessage({pvfiblets:i},"*"),{state:r}=o.camera,s=JSON.stringify(r);window.addEventListener("message",i=>{let a=i.source===n?i.data?.pvfiblets:void 0;if(!a)return;let{camera:l,picked:c}=a;if(l&&Ve(l.position)&&Ve(l.focal_point)&&Ve(l.up)&&l.view_angle>0&&l.parallel_scale>0){Object.assign(r,l);let u=JSON.stringify(r);u!==s&&o.change(),s=u}c!==void 0&&e.mark(c)}),o.finished=()=>{let i=JSON.stringify(r);i!==s&&t({camera:JSON.parse(s=i)})},e.told=i=>t({picked:i}),t({ready:!0})}var ye=class{constructor(e,n){h(this,"file",e);h(this,"bytes");h(this,"come",0);h(this,"whole",null);h(this,"waiting",[]);h(this,"had",[]);this.bytes=new Uint8Array(n)}async need(e,n){n<=e||this.had.some(([t,r])=>t<=e&&r>=n)||(this.whole||await this.tried(e,n),this.whole&&await this.upTo(n))}async tried(e,n){for(let t=2;;--t)try{return await this.ask(e,n)}catch(r){if(!(r instanceof TypeError))throw r;if(!t)throw new Error(`${this.file} cannot be read: the connection to its server broke, or there is no server. Files beside a page need one; "python -m http.server" is enough.`);await new Promise(s=>setTimeout(s,500))}}async ask(e,n){let t=await fetch(this.file,{headers:{Range:`bytes=${e}-${n-1}`}});if(!t.ok)throw new Error(`${this.file} cannot be read (${t.status}); it must lie beside this page.`);if(t.status!==206){this.whole?t.body?.cancel():this.whole=this.flow(t);return}let r=Number(/\/(\d+)$/.exec(t.headers.get("Content-Range")??"")?.[1]??this.bytes.length),s=new Uint8Array(await t.arrayBuffer());if(r!==this.bytes.length||s.length!==n-e)throw this.changed(r);this.bytes.set(s,e),this.had.push([e,n])}async flow(e){let n=e.body.getReader();for(;;){let{done:t,value:r}=await n.read();if(t)break;if(this.come+r.length>this.bytes.length)throw this.changed(this.come+r.length);this.bytes.set(r,this.come),this.come+=r.length,this.waiting=this.waiting.filter(s=>s.end<=this.come?s.resolve():!0)}if(this.come!==this.bytes.length)throw this.changed(this.come)}async upTo(e){e>this.come&&await Promise.race([this.whole,new Promise(n=>this.waiting.push({end:e,resolve:n}))])}changed(e){return new Error(`${this.file} has ${e} bytes, and this page was made with one of ${this.bytes.length}. Copy the page and its folder again.`)}};var Qe=6;function ft({leaves:o,program:e}){let n=[];for(let t of e)t>=0?n.push(o[t].ball?`sphere_holds(${t},z)`:`planes_hold(${t},${o[t].planes.length},z)`):t===-3?n.push(`!${n.pop()}`):n.push(`(${n.pop()}${t===-1?"&&":"||"}${n.pop()})`);return n[0]}function ht({leaves:o},e,n,t){let r=ee(e),s=[n,t,1,1],i=[0,1,2,3];if(!r)return null;let a=new Float64Array(4*Qe*o.length),l=new Float64Array(4*o.length);return o.forEach(({centre:c,planes:u,ball:f},d)=>{let[p,g,b,m]=k(e,c),v=[p/m,g/m,b/m],w=m>0&&v.every(isFinite)?v.map((E,_)=>Math.min(Math.max(E,0),s[_])):[n/2,t/2,0],I=E=>{let _=i.map(B=>i.reduce((S,D)=>S+E[D]*r[D+4*B],0));return _[3]+=_[0]*w[0]+_[1]*w[1]+_[2]*w[2],_},M=E=>{let _=Math.max(...E.map((B,S)=>Math.abs(B*s[S])))||1;return E.map((B,S)=>Math.abs(B*s[S])<1e-30*_?0:B/_)};if(l.set(w,4*d),u&&u.forEach((E,_)=>a.set(M(I(E)),4*(Qe*d+_))),!f)return;let x=[...f,[0,0,0,1]].map(I),A=i.map(E=>i.map(_=>x.reduce((B,S,D)=>B+(D<3?1:-1)*S[E]*S[_],0))),L=Math.max(...i.flatMap(E=>i.map(_=>Math.abs(A[E][_]*s[E]*s[_]))))||1;a.set([A[0][0],A[1][1],2*A[0][1],A[3][3],2*A[0][3],2*A[1][3],A[0][2],A[1][2],A[2][2],A[2][3]].map(E=>E/L),4*Qe*d)}),{rays_rows:a,rays_centres:l}}function Nt(o,e,n){let t=e.slice(0,6).map(r=>[0,1,2,3].map(s=>r[0]*n[4*s]+r[1]*n[4*s+1]+r[2]*n[4*s+2]+r[3]*n[4*s+3]));o.ints({plane_count:t.length}),t.forEach((r,s)=>o.set({[`planes[${s}]`]:r}))}var Ue=class{constructor(e,n,t){h(this,"gl",e);h(this,"layer",n);h(this,"array");h(this,"buffers",[]);h(this,"count");h(this,"table",null);h(this,"tableRange",[0,1,1,1]);h(this,"model");this.model=new Float64Array(n.matrix??[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]),this.array=e.createVertexArray(),e.bindVertexArray(this.array);let r=(i,a,l,c,u)=>{let f=e.createBuffer();e.bindBuffer(e.ARRAY_BUFFER,f),e.bufferData(e.ARRAY_BUFFER,a,e.STATIC_DRAW),e.enableVertexAttribArray(i),e.vertexAttribPointer(i,l,c,u,0,0),this.buffers.push(f)};r(0,t[n.places],3,e.FLOAT,!1),n.normals!==void 0&&r(1,t[n.normals],3,e.FLOAT,!1),n.colours!==void 0&&r(2,t[n.colours],4,e.UNSIGNED_BYTE,!0),n.values!==void 0&&(r(3,t[n.values],1,e.FLOAT,!1),[this.table,this.tableRange]=Le(e,N(n.table),n.clim,!!n.log));let s=e.createBuffer();e.bindBuffer(e.ELEMENT_ARRAY_BUFFER,s),e.bufferData(e.ELEMENT_ARRAY_BUFFER,t[n.triangles],e.STATIC_DRAW),this.buffers.push(s),this.count=t[n.triangles].byteLength/4,e.bindVertexArray(null)}get translucent(){return this.layer.opacity<1}draw(e,n){let t=this.gl,{layer:r}=this,s=R(n.view,this.model),i=be(s),a=ee(s),l=a?[a[0],a[4],a[8],a[1],a[5],a[9],a[2],a[6],a[10]]:i;e.use().set({clip_from_data:ke(R(n.projection,s)),view_from_data:ke(s),normal_to_view:l,parallel:n.parallel?1:0,opacity:r.opacity,reflects:r.reflects,sheen:r.sheen}),e.ints({smooth_normals:r.normals===void 0?0:1,lighting:r.lighting?1:0,by_value:this.table?1:0,logarithm:r.log?1:0}),e.textures({table:this.table}).set({table_range:this.tableRange}),n.lights(e),Nt(e,[...r.planes??[],...n.planes],this.model),t.bindVertexArray(this.array),r.normals===void 0&&t.vertexAttrib3f(1,0,0,1),r.colours===void 0&&t.vertexAttrib4f(2,r.colour[0],r.colour[1],r.colour[2],1),t.drawElements(t.TRIANGLES,this.count,t.UNSIGNED_INT,0),t.bindVertexArray(null)}release(){for(let e of this.buffers)this.gl.deleteBuffer(e);this.gl.deleteVertexArray(this.array),this.table&&this.gl.deleteTexture(this.table)}depth(e){let n=this.layer.bounds,t=[(n[0]+n[1])/2,(n[2]+n[3])/2,(n[4]+n[5])/2];return-(e[2]*t[0]+e[6]*t[1]+e[10]*t[2]+e[14])}},Ce=class{constructor(e,n,t){h(this,"gl",e);h(this,"layer",n);h(this,"texture");let[r,s]=n.size;this.texture=e.createTexture(),e.bindTexture(e.TEXTURE_2D,this.texture),e.texImage2D(e.TEXTURE_2D,0,e.RGBA8,r,s,0,e.RGBA,e.UNSIGNED_BYTE,t[n.pixels]);for(let i of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])e.texParameteri(e.TEXTURE_2D,e[i],n.smooth?e.LINEAR:e.NEAREST);for(let i of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])e.texParameteri(e.TEXTURE_2D,e[i],e.CLAMP_TO_EDGE)}get translucent(){return this.layer.clear||this.layer.opacity<1}release(){this.gl.deleteTexture(this.texture)}draw(e,n){let{layer:t}=this;e.use().set({clip_from_data:ke(R(n.projection,n.view)),corner:t.corner,across:t.across,up:t.up,opacity:t.opacity}),e.textures({pixels:this.texture}),this.gl.bindVertexArray(null),this.gl.drawArrays(this.gl.TRIANGLE_STRIP,0,4)}};var Gt=60,dt=45,pt=400,Yt=.5,he=16,xe=4,Vt=40,Ae=4294967295,Qt=1065353216,qt={direction:0,solid:1,streamline:2,value:3,point:4},Ht={none:0,line:1,illuminated:2},qe=class{constructor(e,n,t,r,s,i){h(this,"gl",e);h(this,"layer",n);h(this,"index",t);h(this,"set");h(this,"model");h(this,"values",null);h(this,"colours",null);h(this,"table",null);h(this,"tableRange",[0,1,1,1]);h(this,"kept",null);h(this,"chosen",null);h(this,"keptPoints",null);h(this,"shownValues",[1,0]);h(this,"marked",Ae);this.set=i??new Se(e,s),this.set.advance(s.ready),this.model=new Float64Array(n.matrix??Ie());let{colours:a}=n;a.codes?this.values=this.set.codedValues(a.values,lt(r[a.codes.data],a.codes.bits),a.codes):a.values!==void 0&&(this.values=this.set.pointValues(a.values)),a.data!==void 0&&(this.colours=X(e,"rgba8",r[a.data],"colours")),a.table!==void 0&&([this.table,this.tableRange]=Le(e,N(a.table),a.clim,!!a.log)),n.kept!==void 0&&this.keep(r[n.kept]),n.chosen&&(this.chosen=X(e,"r8ui",r[n.chosen.data],"streamlines")),n.kept_points!==void 0&&(this.keptPoints=X(e,"r32ui",ue(r[n.kept_points]),"points"))}release(){this.values&&this.set.forget(this.values);for(let e of[this.colours,this.table,this.kept,this.chosen,this.keptPoints])e&&this.gl.deleteTexture(e)}get byPoint(){return this.layer.colours.mode==="point"}keep(e){this.kept&&this.gl.deleteTexture(this.kept),this.kept=e&&X(this.gl,"r8ui",e,"streamlines")}},_e=class{constructor(e,n,t,r){h(this,"canvas",e);h(this,"scene",n);h(this,"data",t);h(this,"archives",r);h(this,"camera");h(this,"lines",[]);h(this,"surfaces",[]);h(this,"images",[]);h(this,"planes",[]);h(this,"width",0);h(this,"height",0);h(this,"ratio",1);h(this,"frames",0);h(this,"few",2e5);h(this,"loading",!1);h(this,"failed",null);h(this,"drawnOnce",null);h(this,"presented",null);h(this,"grown",null);h(this,"finished",null);h(this,"gl");h(this,"programs",new Map);h(this,"frameBlock");h(this,"clipBlock");h(this,"raysBlock",null);h(this,"textures",{});h(this,"buffers",{});h(this,"frame",null);h(this,"rest",null);h(this,"sync",null);h(this,"sliceStarted",0);h(this,"sliceSize",0);h(this,"rate",1e3);h(this,"dirty",!0);h(this,"moving",!1);h(this,"asked",0);h(this,"still",0);h(this,"waiting",[]);h(this,"restored",null);this.camera=new Re(structuredClone(n.camera));let s=e.getContext("webgl2",{alpha:!1,antialias:!1,depth:!1,preserveDrawingBuffer:!1,powerPreference:"high-performance"});if(!s)throw new ae("This browser has no WebGL 2, which the page draws with. Turn on graphics acceleration in its settings, or open the page in another browser.");this.gl=s,e.addEventListener("webglcontextlost",i=>{i.preventDefault(),this.frame=this.rest=null,this.sync=null}),e.addEventListener("webglcontextrestored",()=>this.guarded(()=>this.begin())),this.begin()}guarded(e){try{e()}catch(n){this.gl.isContextLost()||this.failed?.(n)}}begin(){let{gl:e}=this,n=this.lines.splice(0);this.programs.clear(),this.rest=null,this.textures={},this.buffers={},this.width=this.height=0,this.surfaces.length=this.images.length=0,this.frameBlock=new O(e,"Frame"),this.clipBlock=new O(e,"ClipPlanes"),this.raysBlock=null,this.fill(new Map,new Map),n.forEach((t,r)=>{let s=this.lines[r];s.shownValues=t.shownValues,s.marked=t.marked}),this.restored?.(),this.change()}fill(e,n){let{gl:t,scene:r}=this;r.layers.forEach(i=>{i.kind==="surface"?this.surfaces.push(n.get(JSON.stringify(i))??new Ue(t,i,this.data)):i.kind==="image"?this.images.push(n.get(JSON.stringify(i))??new Ce(t,i,this.data)):this.lines.push(new qe(t,i,this.lines.length,this.data,this.archives.get(i.data),e.get(this.data[i.data])))});let s=Math.min(1024,128*(navigator.deviceMemory??4))*2**20;for(let i of this.lines)i.set.budget=s/this.lines.length}update(e,n,t){if(this.gl.isContextLost())return;let{data:r}=this,s=this.lines.splice(0),i=this.surfaces.splice(0),a=this.images.splice(0),l=new Map(s.map(u=>[r[u.layer.data],u.set])),c=({layer:u})=>(u.kind==="image"?[u.pixels]:[u.places,u.triangles,u.normals,u.colours,u.values]).every(f=>f===void 0||r[f]===n[f]);this.frame=this.rest=null,this.scene=e,this.data=n,this.archives=t,this.fill(l,new Map([...i,...a].filter(c).map(u=>[JSON.stringify(u.layer),u])));for(let u of s)u.release();for(let u of a)this.images.includes(u)||u.release();for(let{set:u}of s)this.lines.some(f=>f.set===u)||u.release();for(let u of i)this.surfaces.includes(u)||u.release();this.change()}program(e,n,t=[]){let r=[e,n,...t].join(" "),s=this.programs.get(r);return s||this.programs.set(r,s=new le(this.gl,e,n,t)),s}change(e=!1){this.dirty=!0,this.moving=e,window.clearTimeout(this.still),e&&(this.still=window.setTimeout(()=>this.change(),200)),this.schedule()}grow(){this.guarded(()=>{let e=this.frame??this.rest;for(let n of this.lines){let{set:t}=n,r=t.blocks.length;if(t.advance(this.archives.get(n.layer.data).ready),!e||!n.layer.visible)continue;let s=e.jobs.length;if(this.addJobs(e,n,t.blocks.slice(r)),t.segments(t.blocks.reduce((a,l)=>a+l.items,0))<=this.few)continue;let i=e.jobs.splice(s);for(let a of["likely","others"])e.jobs.push(...i.map(l=>({...l,what:a})))}e?this.dirty||(this.frame=e):this.change(),this.grown?.()}),this.schedule()}addJobs(e,n,t){let r=R(e.matrices.projection,R(e.matrices.view,n.model));for(let s of t)this.outside(r,s.bounds)||e.jobs.push({lines:n,block:s,what:"all"})}findFarTiles(e,n){let{gl:t,textures:r}=this,s=Math.ceil(this.width/xe),i=Math.ceil(this.height/xe);if(t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.far),!e)return t.clearBufferuiv(t.COLOR,0,[Qt,0,0,0]),null;if(t.disable(t.DEPTH_TEST),t.bindVertexArray(null),t.viewport(0,0,s,i),this.program("page/screen.vert","page/far_tiles.frag").use().textures({depths:r.depths}),t.drawArrays(t.TRIANGLES,0,3),t.viewport(0,0,this.width,this.height),!n)return null;let a=new Uint32Array(4*s*i);return t.readPixels(0,0,s,i,t.RGBA_INTEGER,t.UNSIGNED_INT,a),{size:xe,columns:s,rows:i,depths:new Float32Array(a.buffer)}}schedule(){let e=()=>this.guarded(()=>this.tick());this.asked||(this.asked=this.sync&&this.frame&&!this.frame.moving?window.setTimeout(e,1):requestAnimationFrame(e))}settled(){return!this.dirty&&!this.frame&&!this.loading?Promise.resolve():new Promise(e=>this.waiting.push(e))}tick(){this.asked=0;let{gl:e}=this;if(e.isContextLost())return;if(this.sync){if(e.getSyncParameter(this.sync,e.SYNC_STATUS)!==e.SIGNALED)return this.schedule();e.deleteSync(this.sync),this.sync=null;let s=Math.max(performance.now()-this.sliceStarted,.5);this.sliceSize>2e3&&(this.rate+=.5*(Math.min(this.sliceSize/s,8*this.rate)-this.rate))}this.fit(),this.dirty&&this.start();let n=this.frame;if(!n)return;let t=this.rate*Gt;this.sliceStarted=performance.now(),this.sliceSize=0,this.drawSlice(n,n.moving?1/0:t);let r=n.next>=n.jobs.length;(r||this.worthShowing(n))&&(n.shownAt=performance.now(),this.present(n.matrices,r),this.drawnOnce&&(n.jobs.length||!this.loading)&&(this.drawnOnce(),this.drawnOnce=null)),this.sync=e.fenceSync(e.SYNC_GPU_COMMANDS_COMPLETE,0),e.flush(),r&&(this.frame=null,this.rest=n.moving?null:n,++this.frames,n.moving||this.finished?.(),!n.moving&&!this.dirty&&!this.loading&&this.waiting.splice(0).forEach(s=>s())),this.schedule()}worthShowing({jobs:e,next:n,begun:t,shownAt:r}){let s=performance.now(),{what:i}=e[n],a=c=>c.what===i,l=(s-t)*e.slice(n).filter(a).length/Math.max(e.slice(0,n).filter(a).length,1);return s-r>Math.max(pt,Yt*(r-t))&&(!this.frames||l>pt)}fit(){let{gl:e,canvas:n}=this,t=window.devicePixelRatio||1,r=e.getParameter(e.MAX_TEXTURE_SIZE)-2,s=Math.min(r,Math.max(1,Math.round(n.clientWidth*t))),i=Math.min(r,Math.max(1,Math.round(n.clientHeight*t)));if(s===this.width&&i===this.height)return;n.width=this.width=s,n.height=this.height=i,this.ratio=t;for(let l of Object.values(this.textures))e.deleteTexture(l);for(let l of Object.values(this.buffers))e.deleteFramebuffer(l);let a=this.textures={texels:te(e,e.RGBA32UI,s,i),depths:te(e,e.DEPTH_COMPONENT32F,s,i),drawn:te(e,e.RGBA8,s,i),shown:te(e,e.RGBA32UI,s+2,i+2),tiles:te(e,e.R8UI,Math.ceil(s/he),Math.ceil(i/he)),far:te(e,e.R32UI,Math.ceil(s/xe),Math.ceil(i/xe))};this.buffers={texels:ne(e,a.texels,a.depths),scene:ne(e,a.drawn,a.depths),drawn:ne(e,a.drawn,null),shown:ne(e,a.shown,null),tiles:ne(e,a.tiles,null),far:ne(e,a.far,null)},this.dirty=!0}start(){let{gl:e,camera:n,scene:t}=this,r=this.moving;this.dirty=!1;let s=n.view(),i=n.projection(this.width/this.height,t.bounds),a={view:s,projection:i,parallel:n.state.parallel,lights:u=>this.setLights(u,s),planes:this.planes},l=this.frame={jobs:[],next:0,share:1,drawn:0,begun:performance.now(),shownAt:performance.now(),matrices:a,moving:r};this.rest=null;for(let u of this.lines)u.layer.visible&&this.addJobs(l,u,u.set.blocks);let c=u=>l.jobs.reduce((f,d)=>f+d.lines.set.segments(u(d)),0);if(c(({block:u})=>u.items)>this.few){let u=({lines:d,block:{bounds:p}})=>k(R(s,d.model),[p[0]+p[1],p[2]+p[3],p[4]+p[5]].map(g=>g/2))[2],f=new Map(l.jobs.map(d=>[d,u(d)]));l.jobs.sort((d,p)=>f.get(p)-f.get(d)),l.jobs=l.jobs.map(d=>({...d,what:"likely"})),r?l.share=Math.min(1,this.rate*dt/c(({lines:d,block:p})=>(d.set.likely(p),p.likelies))):l.jobs.push(...l.jobs.map(d=>({...d,what:"others"})))}else r&&(l.share=Math.min(1,this.rate*dt/Math.max(c(({block:u})=>u.items),1)));this.frames||(l.shownAt=0),e.viewport(0,0,this.width,this.height),e.disable(e.BLEND),e.disable(e.CULL_FACE),e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.texels),e.clearBufferuiv(e.COLOR,0,[Ae,Ae,0,0]),e.depthMask(!0),e.clearBufferfv(e.DEPTH,0,[1]),this.drawBackdrop(a)}drawBackdrop(e){let{gl:n,scene:t}=this;n.bindFramebuffer(n.FRAMEBUFFER,this.buffers.scene),n.disable(n.DEPTH_TEST),n.bindVertexArray(null),this.program("page/screen.vert","page/background.frag").use().set({bottom:t.background[0],top:t.background[1],height:this.height}),n.drawArrays(n.TRIANGLES,0,3),n.enable(n.DEPTH_TEST),n.depthFunc(n.LEQUAL),n.depthMask(!0);let r=this.program("page/surface.vert","page/surface.frag");for(let i of this.surfaces)i.layer.visible&&!i.translucent&&i.draw(r,e);let s=this.program("page/image.vert","page/image.frag");for(let i of this.images)i.layer.visible&&!i.translucent&&i.draw(s,e)}outside(e,n){let t=[0,0,0,0,0,0];for(let r=0;r<8;++r){let[s,i,a,l]=k(e,[n[r&1],n[2+(r>>1&1)],n[4+(r>>2)]]);[s<-l,s>l,i<-l,i>l,a<-l,a>l].forEach((c,u)=>t[u]+=c?1:0)}return t.some(r=>r===8)}setLights(e,n){let t=[0,0,0],r=0;this.scene.lights.slice(0,8).forEach((s,i)=>{let a=[0,0,1,0];s.view?a=[...s.view,0]:s.world&&(r=1,a=k(n,s.world,s.positional?1:0),a[3]=s.positional?1:0),e.set({[`light_colour[${i}]`]:s.colour,[`light_place[${i}]`]:a}),s.colour.forEach((l,c)=>t[c]+=l)}),e.ints({light_count:Math.min(this.scene.lights.length,8)}).set({light_sum:t,light_standing:r})}aim(e,n){let t=e.layer.line_width*this.ratio,r=t>1,s=R(n.view,R(e.model,e.set.toData)),i=R(n.projection,s),a=i.reduce((u,f)=>Math.max(u,Math.abs(f)),0)||1,l=new Float64Array(16);for(let u=0;u<4;++u){let[f,d,p,g]=[0,1,2,3].map(b=>i[b+4*u]/a);l.set([this.width/2*(f+g),this.height/2*(d+g),(p+g)/2,g],4*u)}this.frameBlock.write({window_from_local:l,reference:e.set.reference,half_line_width:r?t/2:0,viewport:[this.width,this.height]},["reference"]),this.frameBlock.bind();let c=[...e.layer.planes??[],...this.planes].slice(0,8);if(c.length){let u=R(e.model,e.set.toData),f=ee(i),d=new Float64Array(32),p=new Float64Array(32);c.forEach((g,b)=>{let m=[0,1,2,3].map(w=>g[0]*u[4*w]+g[1]*u[4*w+1]+g[2]*u[4*w+2]+g[3]*u[4*w+3]),v=Math.hypot(m[0],m[1],m[2])||1;if(m.forEach((w,I)=>d[4*b+I]=w/v),f)for(let w=0;w<2;++w){let I=[0,1,2,3].reduce((M,x)=>M+d[4*b+x]*f[x+4*w],0);p[4*b+w]=I*a*(2/(w===0?this.width:this.height))}}),this.clipBlock.write({clip_planes:d,clip_tilts:p,clip_plane_count:0,clip_rounding:0}),this.clipBlock.write({clip_plane_count:c.length},["clip_plane_count"]),this.clipBlock.bind()}return{wide:r,clipped:c.length>0,window:l}}cut(e,n){let{width:t,height:r}=this,s=new Float64Array([t/2,0,0,0,0,r/2,0,0,0,0,.5,0,t/2,r/2,.5,1]),i=ht(e,R(s,R(n.projection,n.view)),t,r);return i?((this.raysBlock??(this.raysBlock=new O(this.gl,"Rays"))).write(i),this.raysBlock.bind(),!0):!1}pixelsOf(e,n,t){let r=R(n.projection,R(n.view,e.model)),s=e.set.bounds,i=Math.hypot(...be(e.model)),a=1/0;for(let l=0;l<8;++l)a=Math.min(a,k(r,[s[l&1],s[2+(l>>1&1)],s[4+(l>>2)]])[3]);return a>0?t*i*(this.height/2)*n.projection[5]/a:1/0}drawSlice(e,n){let{gl:t}=this,r=null,s=null,i=!1,a=Ie(),l=1,c=e.jobs[e.next]?.what==="others",u=this.findFarTiles(e.next>0,c);for(;e.next<e.jobs.length&&this.sliceSize<n;){let{lines:f,block:d,what:p}=e.jobs[e.next];if(p==="others"!==c&&this.sliceSize)break;if(++e.next,f.set.pointsOf(d),r!==f){r=f;let b=this.aim(f,e.matrices),{wide:m,clipped:v}=b;a=b.window,l=1+(m?f.layer.line_width*this.ratio/2:0);let w=["CLIPPING","CLIPPING_DEPTH","EDGES"];m&&w.push("WIDE_LINES"),v&&w.push("CLIP_PLANES"),f.layer.cut&&this.cut(f.layer.cut,e.matrices)&&w.push("CLIP_REGION",`REGION ${ft(f.layer.cut)}`),i=!m&&this.pixelsOf(f,e.matrices,f.set.longestStep)<=Vt,i&&w.push("SPRITES"),f.values&&w.push("VALUES_STORED"),f.byPoint&&w.push("VALUES_COLOUR"),f.kept&&w.push("STREAMLINE_MASK"),f.keptPoints&&w.push("POINT_MASK"),s=this.program("page/segment.vert","page/segment.frag",w).use(),f.values&&s.set({value_code:f.values.code,shown_values:f.shownValues}),s.uints({layer:f.index*2**28})}let g=p==="others"&&u?f.set.look(d,a,l,this.width,this.height,u):f.set.likely(d);t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.texels),t.enable(t.DEPTH_TEST),t.depthFunc(t.LESS),this.frameBlock.bind(),s.use().textures({far_tiles:this.textures.far,items:f.set.items,kept:f.kept,kept_points:f.keptPoints,value_texels:f.values&&f.values.texture,point_colours:f.byPoint?f.colours:null}),p==="all"?this.sliceSize+=f.set.draw(d,s,e.share*d.items,i):this.sliceSize+=d.items+f.set.drawSome(d,s,g,i,Math.ceil(e.share*(p==="likely"?d.likelies:d.items)))}}present(e,n){let{gl:t,textures:r,buffers:s}=this;this.repaint(e),t.disable(t.DEPTH_TEST),t.bindVertexArray(null),this.findTiles(),t.bindFramebuffer(t.FRAMEBUFFER,s.drawn);let i=this.program("page/tiles.vert","page/resolve.frag").use(),a=ee(e.projection)??Ie(),l=0;for(let c of this.lines){if(!c.layer.visible)continue;let{layer:u}=c,{colours:f}=u,d=u.line_width*this.ratio;l=Math.max(l,1-Math.min(1,d)),i.textures({texels:r.texels,depths:r.depths,colours:c.byPoint?null:c.colours,table:c.table,chosen:c.chosen??r.texels}),i.uints({layer:c.index*2**28,marked:c.marked}),i.ints({mode:qt[f.mode],logarithm:f.log?1:0,light:Ht[u.light]}),i.set({one_colour:f.colour??[1,1,1],table_range:c.tableRange,reflects:u.reflects,sheen:u.sheen,chosen_colour:u.chosen?.colour??[0,0,0,0],faded:u.chosen?.faded??[0,0,0,0],data_to_view:be(R(e.view,c.model)),pixel_to_view:new Float32Array(a),picture:[this.width,this.height]}),this.setLights(i,e.view),this.drawTiles(i)}if(this.drawTranslucent(e),t.disable(t.DEPTH_TEST),t.bindVertexArray(null),n&&this.scene.antialias&&this.lines.length){t.bindFramebuffer(t.FRAMEBUFFER,s.shown),t.viewport(0,0,this.width+2,this.height+2),this.program("page/screen.vert","page/visible_edges.frag").use().textures({texels:r.texels,depths:r.depths,drawn:r.drawn}).set({narrower:l}),t.drawArrays(t.TRIANGLES,0,3),t.viewport(0,0,this.width,this.height),t.bindFramebuffer(t.FRAMEBUFFER,s.drawn);let c=this.program("page/tiles.vert","effects/picture/antialias_coverage.frag").use().textures({shown:r.shown});t.uniform2i(c.at("shift"),1,1),this.drawTiles(c)}t.bindFramebuffer(t.FRAMEBUFFER,null),this.program("page/screen.vert","page/copy.frag").use().textures({drawn:r.drawn}),t.drawArrays(t.TRIANGLES,0,3),this.presented?.()}findTiles(){let{gl:e,textures:n}=this;e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.tiles),e.viewport(0,0,Math.ceil(this.width/he),Math.ceil(this.height/he)),this.program("page/screen.vert","page/tile_mask.frag").use().textures({texels:n.texels}),e.drawArrays(e.TRIANGLES,0,3),e.viewport(0,0,this.width,this.height)}drawTiles(e){let{gl:n}=this;e.textures({tiles:this.textures.tiles}).set({whole:[this.width,this.height]}),n.drawArraysInstanced(n.TRIANGLE_STRIP,0,4,Math.ceil(this.width/he)*Math.ceil(this.height/he))}repaint(e){this.frame&&this.frame.drawn++>0&&this.drawBackdrop(e)}drawTranslucent(e){let{gl:n}=this,t=this.surfaces.filter(a=>a.layer.visible&&a.translucent),r=this.images.filter(a=>a.layer.visible&&a.translucent);if(!t.length&&!r.length)return;n.bindFramebuffer(n.FRAMEBUFFER,this.buffers.scene),n.enable(n.DEPTH_TEST),n.depthFunc(n.LEQUAL),n.depthMask(!1),n.enable(n.BLEND),n.blendFunc(n.SRC_ALPHA,n.ONE_MINUS_SRC_ALPHA);let s=this.program("page/surface.vert","page/surface.frag");t.sort((a,l)=>l.depth(e.view)-a.depth(e.view)).forEach(a=>a.draw(s,e));let i=this.program("page/image.vert","page/image.frag");r.forEach(a=>a.draw(i,e)),n.disable(n.BLEND),n.depthMask(!0)}pick(e,n){let{gl:t}=this,r=Math.floor(e*this.ratio),s=this.height-1-Math.floor(n*this.ratio),i=new Uint32Array(4),a=[[0,0],[1,0],[-1,0],[0,1],[0,-1],[2,0],[-2,0],[0,2],[0,-2]];for(let[l,c]of a){if(r+l<0||s+c<0||r+l>=this.width||s+c>=this.height||(t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.texels),t.readPixels(r+l,s+c,1,1,t.RGBA_INTEGER,t.UNSIGNED_INT,i),i[0]===Ae&&i[1]===Ae))continue;let u=this.lines[i[0]>>>28];if(!u)continue;let f=u.values?new Float32Array(new Uint32Array([i[3]]).buffer)[0]:null;return{lines:u,streamline:i[0]&268435455,value:f}}return null}placeOf(e,n,t,r){let{camera:s,scene:i,canvas:a}=this,l=a.clientWidth,c=a.clientHeight,u=R(s.projection(this.width/this.height,i.bounds),R(s.view(),e.model)),f=[0,0,0],d=1/0;for(let p of e.set.pointsOfStreamline(n)){let[g,b,,m]=k(u,p),v=Math.hypot((g/m+1)*l/2-t,(1-b/m)*c/2-r);m>0&&v<d&&([f,d]=[p,v])}return f}pixels(){let{gl:e,width:n,height:t}=this,r=new Uint8Array(4*n*t),s=new Uint8Array(r.length);e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.drawn),e.readPixels(0,0,n,t,e.RGBA,e.UNSIGNED_BYTE,r);for(let i=0;i<t;++i)s.set(r.subarray(4*n*i,4*n*(i+1)),4*n*(t-1-i));return s}};var mt=o=>document.getElementById(o)?.textContent??"",de=4;async function Xt(o){let e=new Set(o.layers.map(n=>n.kind==="fiblets"?n.data:-1));return Promise.all(o.data.map(async(n,t)=>{if(n.file===void 0)return N(mt(`data-${t}`).trim());if(e.has(t))return new Uint8Array;let r=new ye(n.file,n.bytes);return await r.need(0,n.bytes),r.bytes}))}async function Wt(o,e,n){let t=new Map;return await Promise.all(o.layers.map(async r=>{if(r.kind!=="fiblets")return;let{file:s,bytes:i}=o.data[r.data];if(s===void 0){t.set(r.data,Oe(e[r.data]));return}let a=new ye(s,i),l=r.colours.values===void 0?[]:[r.colours.values],c=await Je(a,l);t.set(r.data,c),n.push({archive:c,remote:a,values:l})})),t}async function Kt(o,e){let n=document.createElement("progress"),t=1<<se;n.setAttribute("aria-label","Streamlines that have come"),n.max=o.reduce((r,{archive:s})=>r+s.header.n_fiblets,0),document.getElementById("over").append(n),await Promise.all(o.map(async({archive:r,remote:s,values:i})=>{let a=r.header.n_fiblets,l=Math.ceil(a/t),c=f=>je(s,r,f,Math.min(f+de,l),t,i),u=c(0);for(let f=0;f<l;f+=de){let d=u;f+de<l&&(u=c(f+de)).catch(()=>{}),await d,n.value+=Math.min((f+de)*t,a)-r.ready,r.ready=Math.min((f+de)*t,a),e.grow()}})),n.remove()}function gt(o){let e=document.getElementById("message");e.textContent=o instanceof Error?o.message:String(o),e.hidden=!1,document.body.dataset.state="failed"}async function Jt(){let o=JSON.parse(mt("scene"));document.title=o.title;let e=await Xt(o),n=[],t=await Wt(o,e,n),r=new _e(document.getElementById("view"),o,e,t);r.loading=n.length>0,r.failed=gt,r.drawnOnce=()=>{document.body.dataset.state="drawn"},new ResizeObserver(()=>r.change()).observe(r.canvas);let s=new De(r,e);if(Ye(r,(i,a)=>s.pick(i,a)),ut(r,s),window.pvfiblets=r,!!n.length)try{await Kt(n,r)}finally{r.loading=!1,r.grow()}}window.pvfibletsPage={Renderer:_e,attachMouse:Ye,readArchive:Oe};document.getElementById("scene")&&Jt().catch(gt);})();
