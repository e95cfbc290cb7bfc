// Built by `make client` of sources b8b29d553c4eabba
"use strict";(()=>{var pt=Object.defineProperty;var mt=(o,e,n)=>e in o?pt(o,e,{enumerable:!0,configurable:!0,writable:!0,value:n}):o[e]=n;var h=(o,e,n)=>mt(o,typeof e!="symbol"?e+"":e,n);var A=class extends Error{},gt=101010256,vt=101075792,bt=117853008,wt=33639248,qe=67324752,He="header.json",pe="Copy or make the file again.",yt=4096;function H(o,e){return o.getUint32(e,!0)+o.getUint32(e+4,!0)*4294967296}function xt(o){let e=o.byteLength;for(let n=e-22;n>=Math.max(0,e-65558);--n)if(o.getUint32(n,!0)===gt){if(n>=20&&o.getUint32(n-20,!0)===bt){let t=H(o,n-12);if(t+56<=e&&o.getUint32(t,!0)===vt)return[H(o,t+48),H(o,t+32)]}return[o.getUint32(n+16,!0),o.getUint16(n+10,!0)]}throw new A("This is no whole .fiblets file: the end of its zip archive is missing. Copy or make it again.")}function At(o,e,n,t){let i=o.getUint32(e+24,!0),s=o.getUint32(e+42,!0),r=o.getUint32(e+20,!0);for(let a=e+46+n,l=a+t;a+4<=l;){let c=o.getUint16(a,!0),u=o.getUint16(a+2,!0),f=a+4;c===1&&(i===4294967295&&(i=H(o,f),f+=8),r===4294967295&&(r=H(o,f),f+=8),s===4294967295&&(s=H(o,f))),a+=4+u}return[i,s]}var _t={"|u1":[1,Uint8Array],"|i1":[1,Int8Array],"|b1":[1,Uint8Array],"<u2":[2,Uint16Array],"<i2":[2,Int16Array],"<u4":[4,Uint32Array],"<i4":[4,Int32Array],"<f4":[4,Float32Array],"<f8":[8,Float64Array],"<i8":[8,BigInt64Array],"<u8":[8,BigUint64Array]};function Pe(o,e){let n=new A(`The member ${e} of the file is damaged. ${pe}`);if(o.length<10||o[0]!==147||o[6]!==1)throw n;let t=o[8]|o[9]<<8,i=new TextDecoder("latin1").decode(o.subarray(10,10+t)),s=/'descr':\s*'([^']+)'/.exec(i),r=/'shape':\s*\(([^)]*)\)/.exec(i);if(!s||!r||/'fortran_order':\s*True/.test(i))throw n;let a=_t[s[1]];if(!a)return null;let l=r[1].split(",").map(p=>p.trim()).filter(p=>p).map(Number),c=l.reduce((p,g)=>p*g,1),u=o.byteOffset+10+t;if(!l.every(p=>Number.isSafeInteger(p)&&p>=0)||10+t+c*a[0]>o.length)throw n;let f=o.buffer,d=u%a[0]===0?new a[1](f,u,c):new a[1](f.slice(u,u+c*a[0]),0,c);return{shape:l,data:d}}function Oe(o){let e=new DataView(o.buffer,o.byteOffset,o.byteLength);if(o.length<22)throw new A("This is no .fiblets file: it is empty, or cut short.");let[n,t]=xt(e),i=new Map,s=null,r=n;for(let a=0;a<t;++a){if(r+46>o.length||e.getUint32(r,!0)!==wt)throw new A(`The list of the file's members is damaged. ${pe}`);let l=e.getUint16(r+28,!0),c=e.getUint16(r+30,!0),u=e.getUint16(r+32,!0),f=new TextDecoder().decode(o.subarray(r+46,r+46+l)),[d,p]=At(e,r,l,c);if(e.getUint16(r+10,!0)!==0)throw new A(`The member ${f} of the file is compressed; .fiblets files store their members as they are.`);if(p+30>o.length||e.getUint32(p,!0)!==qe)throw new A(`The member ${f} of the file is damaged. ${pe}`);let g=p+30+e.getUint16(p+26,!0)+e.getUint16(p+28,!0);if(g+d>o.length)throw new A(`The file ends within its member ${f}. Copy or make it again.`);let v=o.subarray(g,g+d);if(f===He)s=Xe(v);else{let m=Pe(v,f);m&&i.set(f,m)}r+=46+l+c+u}return Ke(s,i,1/0)}function Xe(o){try{return JSON.parse(new TextDecoder().decode(o))}catch{throw new A(`The file's header is damaged. ${pe}`)}}function Ke(o,e,n){if(o===null||typeof o!="object")throw new A("This is a zip archive, but no .fiblets file: it has no header.json.");return{header:o,arrays:e,ready:n}}async function We(o,e){let{bytes:n}=o,t=new DataView(n.buffer,n.byteOffset,n.byteLength),i=new Map,s=null;for(let r=0;r+30<=n.length&&(await o.need(r,Math.min(r+yt,n.length)),t.getUint32(r,!0)===qe);){let a=t.getUint16(r+26,!0),l=t.getUint16(r+28,!0),c=r+30+a+l,u=new TextDecoder().decode(n.subarray(r+30,r+30+a)),f=t.getUint32(r+18,!0);for(let d=r+30+a;f===4294967295&&d+20<=c;d+=4+t.getUint16(d+2,!0))t.getUint16(d,!0)===1&&(f=H(t,d+4));if(t.getUint16(r+8,!0)!==0||c+f>n.length)throw new A(`The member ${u} of the file is damaged. ${pe}`);if(u===He)await o.need(c,c+f),s=Xe(n.subarray(c,c+f));else{let d=Pe(n.subarray(c,c+f),u);d&&i.set(u,d),d&&(d.data.buffer!==n.buffer||u==="pages.npy")&&(await o.need(c,c+f),i.set(u,Pe(n.subarray(c,c+f),u)))}if(i.has("codes.npy")&&e.every(d=>i.has(s?.per_point?.[d]?.member)))break;r=c+f}return Ke(s,i,0)}var Et=[["anchors.npy",2,-1],["decoding.npy",3,-1],["anchors_low.npy",3,-1],["rank_to_id.npy",1,0],["codes.npy",1,1]];async function Je(o,e,n,t,i,s){let r=e.arrays.get("pages.npy").data,a=e.header.n_fiblets,l=[...Et,...s.map(c=>[e.header.per_point?.[c]?.member,1,2])];await Promise.all(l.map(([c,u,f])=>{let d=e.arrays.get(c)?.data;if(!d)return;let[p,g]=[n,t].map(v=>(f<0?Math.min(v*i,a)*u:Number(r[3*v+f]))*d.BYTES_PER_ELEMENT);return o.need(d.byteOffset+p,Math.min(d.byteOffset+g+(f===1?4:0),o.bytes.length))}))}var z={blocks:{ClipPlanes:{bytes:400,fields:{clip_brushes:256,clip_plane_count:384,clip_planes:0,clip_rounding:388,clip_tilts:128}},Coding:{bytes:96,fields:{anchor_scale:0,end_vector_scale:28,lattice_edge:24,radius_scale:12,rotation_scales:32,step_low:16,step_span:20}},Frame:{bytes:208,fields:{half_line_width:172,line_reach:184,most_pixels_per_mm:192,plane_rounding:188,reference:160,segment_deviation:200,segment_size:204,view_planes:64,viewport:176,w_per_mm:196,window_from_local:0}},Rotations:{bytes:16384,fields:{rotations:0}}},fields:{anchor_x:[0,0,16],anchor_y:[0,16,16],anchor_z:[1,0,16],begin:[1,30,1],cap:[2,26,4],code:[1,0,22],end:[1,31,1],kind:[2,30,2],last:[2,20,6],point:[2,0,20],rank:[1,16,14],shape:[0,0,32],step:[1,22,10]},lines:`#version 300 es
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
#define VARYING flat in
layout(location=0)out uvec4 out_texel;
uniform vec2 shown_values;
bool none(float value){return(floatBitsToUint(value)&0x7FFFFFFFu)>0x7F800000u;}
float value_between(float t){
vec2 ends=seg_along.zw;
if(none(ends.x)||none(ends.y))return t<0.5?ends.x:ends.y;
return mix(ends.x,ends.y,t);
void write(float s,uint edges){
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
if(colour.a==0.0)discard;
colour.a*=opacity;`,page_bits:14,rotation_scales:[39380907423947065e-23,5413425014921813e-22,7445069627465273e-22,1023472805172787e-21,14070004681343562e-22,19338988295203308e-22,2657444838405354e-21,3649580548881204e-21,5006992068956606e-21,6855771061964333e-21,9352394044981338e-21,1266809158551041e-20,1692779733275529e-20,22030990294297226e-21,27206533559365198e-21,300810752378311e-19],rotations:"AAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbRuK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6nLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420biuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07Svlg==",shaders:{"effects/picture/antialias_coverage.frag":[0,5,475,478,668,674,46,47,674,680,10,11,680,682,257,258,682,689,669,670,689,691,46,47,691,693,10,11,693,698,10,11,698,700,10,11,700,705,10,11,705,719,226,227,719,740,10,11],"page/background.frag":[0,5,741,744,631,632,744,745],"page/copy.frag":[0,5,654,655,631,632,740,741],"page/decode.vert":[0,13,10,11,13,55,46,47,55,57,46,47,57,76,72,73,76,77,75,76,77,81,72,73,81,85,75,76,85,87,10,11,87,93,10,11,93,99,10,11,99,105,10,11,105,118,10,11,118,121,10,11,121,125,10,11,125,138,10,11,138,141,10,11,75,76,10,11,141,142,131,132,142,143,75,76,143,146,10,11,75,76,146,157,46,47,157,174,125,126,174,178,10,11,75,76,10,11,178,179,125,126,174,175,179,184,137,138,10,11,75,76,184,186,10,11,186,188,10,11,188,192,10,11,192,193,163,164,193,194,125,126,194,196,154,156,196,198,10,11,75,76,198,199,10,11,199,203,10,11,203,209,10,11,209,212,10,11,212,215,10,11,215,219,10,11,219,243,10,11,243,254,10,11,254,257,10,11],"page/far_tiles.frag":[0,5,368,369,561,563,226,227,563,568,10,11],"page/image.frag":[0,5,794,796,778,779,631,632,226,227,796,799,10,11],"page/image.vert":[0,5,749,750,788,792,226,227,792,794,10,11],"page/none.frag":[0,5,257,259],"page/resolve.frag":[0,5,460,461,14,15,362,368,10,11,574,585,10,11,585,597,10,11,10,11,597,606,10,11,606,607,10,11,607,613,599,600,613,617,10,11,617,618,10,11,551,552,561,562,618,619,390,391,619,632,226,227,632,647,10,11,647,652,10,11,652,654,10,11],"page/screen.vert":[0,5,549,550],"page/segment.frag":[0,5,259,260,262,268,10,11,460,461,34,47,294,297,10,11,297,298,461,468,46,47,468,475,10,11,298,305,46,47,305,308,10,11,75,76,475,484,10,11,379,380,484,489,10,11,75,76,489,500,10,11,75,76,356,357,500,501,14,15,203,209,10,11,209,212,10,11,501,505,10,11,505,506,369,371,75,76,371,379,75,76,379,381,298,299,381,383,75,76,75,76,383,384,506,507,400,401,507,513,10,11,75,76,513,517,400,401,517,520,75,76,377,378,520,521,75,76,521,522,10,11,379,380,298,299,522,523,313,314,523,526,10,11,350,351,10,11,75,76,226,227,526,531,298,299,531,532,75,76,532,534,10,11,83,84,226,227,534,546,10,11,546,549,10,11,75,76],"page/segment.vert":[0,5,259,268,10,11,34,47,268,272,10,11,272,274,120,121,10,11,274,276,120,121,10,11,276,278,10,11,278,282,10,11,282,293,10,11,293,294,10,11,294,297,10,11,297,305,46,47,305,308,10,11,308,312,10,11,312,319,10,11,293,294,10,11,319,320,83,84,320,322,75,76,322,327,46,47,327,336,46,47,336,342,10,11,342,351,10,11,351,354,10,11,354,356,10,11,356,362,10,11,14,15,362,368,10,11,368,371,75,76,371,379,75,76,379,381,298,299,381,383,75,76,75,76,57,58,383,386,379,380,386,387,75,76,387,393,75,76,393,398,10,11,75,76,377,378,398,400,75,76,400,406,10,11,75,76,406,415,10,11,226,227,415,423,391,392,423,424,75,76,424,426,393,394,426,429,75,76,429,430,400,401,430,431,75,76,431,440,377,378,440,441,75,76,379,380,441,442,298,299,442,444,75,76,444,449,83,84,449,451,446,447,451,456,137,138,10,11,456,460,75,76,10,11],"page/surface.frag":[0,5,574,578,580,581,763,765,589,591,765,768,10,11,768,769,10,11,607,613,599,600,613,617,10,11,617,618,10,11,769,779,622,624,779,781,631,632,226,227,781,788,10,11],"page/surface.vert":[0,5,745,757,226,227,757,763,10,11],"page/tile_mask.frag":[0,5,550,553,226,227,553,560,10,11,560,561,10,11],"page/tiles.vert":[0,5,550,551,568,570,226,227,570,574,10,11],"page/visible_edges.frag":[0,5,265,268,10,11,475,476,477,478,551,552,561,562,654,662,10,11,226,227,662,668,10,11]}};var Ft=z.lines.split(`
`);function It(o){let e=[];for(let n=0;n<o.length;n+=2)e.push(...Ft.slice(o[n],o[n+1]));return e.join(`
`)+`
`}var Fe={};for(let[o,e]of Object.entries(z.shaders))Fe[o]=It(e);var me=z.blocks,je=z.rotation_scales,ie=z.page_bits;function D(o){let e=atob(o),n=new Uint8Array(e.length);for(let t=0;t<e.length;++t)n[t]=e.charCodeAt(t);return n}var Ze=D(z.rotations),Rt=z.fields;function M(o,e){let[,n,t]=Rt[o];return t===32?e:e>>>n&(1<<t)-1}var K=(o,e)=>[o[0]-e[0],o[1]-e[1],o[2]-e[2]],N=(o,e,n=1)=>[o[0]+n*e[0],o[1]+n*e[1],o[2]+n*e[2]],W=(o,e)=>[o[0]*e,o[1]*e,o[2]*e],U=(o,e)=>o[0]*e[0]+o[1]*e[1]+o[2]*e[2],re=(o,e)=>[o[1]*e[2]-o[2]*e[1],o[2]*e[0]-o[0]*e[2],o[0]*e[1]-o[1]*e[0]],$e=o=>Math.hypot(o[0],o[1],o[2]),X=o=>W(o,1/($e(o)||1));function E(o,e){let n=new Float64Array(16);for(let t=0;t<4;++t)for(let i=0;i<4;++i){let s=0;for(let r=0;r<4;++r)s+=o[i+4*r]*e[r+4*t];n[i+4*t]=s}return n}function Re(){let o=new Float64Array(16);return o[0]=o[5]=o[10]=o[15]=1,o}function ge(o){let e=Array.from({length:4},(t,i)=>Array.from({length:8},(s,r)=>r<4?o[i+4*r]:r-4===i?1:0));for(let t=0;t<4;++t){let i=t;for(let r=t+1;r<4;++r)Math.abs(e[r][t])>Math.abs(e[i][t])&&(i=r);if(!(Math.abs(e[i][t])>0))return null;[e[t],e[i]]=[e[i],e[t]];let s=e[t][t];for(let r=0;r<8;++r)e[t][r]/=s;for(let r=0;r<4;++r){if(r===t)continue;let a=e[r][t];for(let l=0;l<8;++l)e[r][l]-=a*e[t][l]}}let n=new Float64Array(16);for(let t=0;t<4;++t)for(let i=0;i<4;++i)n[t+4*i]=e[t][i+4];return n}function F(o,e,n=1){return[0,1,2,3].map(t=>o[t]*e[0]+o[t+4]*e[1]+o[t+8]*e[2]+o[t+12]*n)}function ve(o){return[o[0],o[1],o[2],o[4],o[5],o[6],o[8],o[9],o[10]]}var ke=o=>new Float32Array(o);function ze(o,e,n){let t=n*Math.PI/180,i=Math.cos(t),s=Math.sin(t),r=X(e);return N(N(W(o,i),re(r,o),s),r,U(r,o)*(1-i))}var Ie=class{constructor(e){h(this,"state",e)}get forward(){return X(K(this.state.focal_point,this.state.position))}get right(){return X(re(this.forward,this.state.up))}get distance(){return $e(K(this.state.focal_point,this.state.position))}view(){let e=this.forward,n=this.right,t=re(n,e),i=this.state.position;return new Float64Array([n[0],t[0],-e[0],0,n[1],t[1],-e[1],0,n[2],t[2],-e[2],0,-U(n,i),-U(t,i),U(e,i),1])}range(e){let n=this.forward,t=this.state.position,i=1/0,s=-1/0;for(let a=0;a<8;++a){let l=U(n,K([e[a&1],e[2+(a>>1&1)],e[4+(a>>2)]],t));i=Math.min(i,l),s=Math.max(s,l)}let r=Math.max(.005*(s-i),1e-6*Math.abs(s));return i-=r,s+=r,this.state.parallel?[i,Math.max(s,i+1e-6)]:(s=Math.max(s,1e-6),[Math.max(i,.001*s),s])}projection(e,n){let[t,i]=this.range(n),s=new Float64Array(16),r=this.state;if(r.parallel)s[0]=1/(r.parallel_scale*e),s[5]=1/r.parallel_scale,s[10]=-2/(i-t),s[14]=-(i+t)/(i-t),s[15]=1;else{let a=1/Math.tan(r.view_angle*Math.PI/360);s[0]=a/e,s[5]=a,s[10]=-(i+t)/(i-t),s[11]=-1,s[14]=-2*i*t/(i-t)}return s}rotate(e,n){let t=this.state,i=ze(K(t.position,t.focal_point),t.up,-200*e),s=X(re(W(i,-1),t.up));i=ze(i,s,-200*n),t.position=N(t.focal_point,i),t.up=X(re(s,X(W(i,-1))))}roll(e){this.state.up=ze(this.state.up,this.forward,e)}pan(e,n){let t=this.state,i=t.parallel?2*t.parallel_scale:2*this.distance*Math.tan(t.view_angle*Math.PI/360),s=re(this.right,this.forward),r=N(W(this.right,-e*i),s,-n*i);t.position=N(t.position,r),t.focal_point=N(t.focal_point,r)}dolly(e){let n=this.state;n.parallel?n.parallel_scale/=e:n.position=N(n.focal_point,K(n.position,n.focal_point),1/e)}lookAlong(e,n,t){let i=this.state,s=[(t[0]+t[1])/2,(t[2]+t[3])/2,(t[4]+t[5])/2],r=Math.hypot(t[1]-t[0],t[3]-t[2],t[5]-t[4])/2||1,a=r/Math.sin(i.view_angle*Math.PI/360);i.focal_point=s,i.position=N(s,X(e),-a),i.up=n,i.parallel_scale=r}};var Be=class{constructor(e,n){h(this,"lines",e);h(this,"base",n);h(this,"ranges",new Map);h(this,"regions",new Map);h(this,"hidden",new Set);h(this,"groups",[]);h(this,"chosen",null)}get count(){let e=this.chosen;return e?e.reduce((n,t)=>n+t,0):this.lines.set.streamlines}set(e,n,t,i){let s=this.ranges.get(e.name)??{values:n,low:e.range[0],high:e.range[1],whole:e.range};t===0?s.low=i:s.high=i,this.ranges.set(e.name,s),this.apply()}look(e,n){let{set:t,model:i}=this.lines,s=n?this.regions.get(e):void 0;this.regions.set(e,{through:t.through(e,i,s?.blocks,s?.through),blocks:t.blocks.length})}apply(){let e=[...this.ranges.values()].filter(r=>r.low>r.whole[0]||r.high<r.whole[1]),n=[...this.regions].filter(([r])=>r.on);if(!e.length&&!n.length&&!this.hidden.size)return this.keep(this.base);let t=this.lines.set.streamlines,i=new Uint8Array(t),s=this.grouped(t);for(let r=0;r<t;++r){let a=this.base===null||this.base[r]!==0;for(let l of e){let c=1e-6*(l.whole[1]-l.whole[0]);a=a&&l.values[r]>=l.low-c&&l.values[r]<=l.high+c}for(let[l,{through:c}]of n)a=a&&c[r]!==0!==l.inverted;i[r]=a&&s[r]?1:0}this.keep(i)}keep(e){this.chosen=e,this.lines.keep(e)}grouped(e){let n=new Uint8Array(e).fill(1);for(let t of this.hidden)for(let i of t)n[i]=0;for(let t of this.hidden.size?this.groups:[])if(!this.hidden.has(t))for(let i of t)n[i]=1;return n}};function et(o,e,n,t){let i=new Float32Array(7*e);for(let s=0;s<e;++s){let r=4*n*s,a=t(s),l=r+4*(Math.min(a,n)-1),c=7*s,u=o[l]-o[r],f=o[l+1]-o[r+1],d=o[l+2]-o[r+2],p=u*u+f*f+d*d||1,g=0;for(let v=r+4;v<r+4*a;v+=4){let m=o[v]-o[r],b=o[v+1]-o[r+1],y=o[v+2]-o[r+2],T=Math.min(Math.max((m*u+b*f+y*d)/p,0),1),k=m-T*u,x=b-T*f,I=y-T*d;g=Math.max(g,k*k+x*x+I*I)}for(let v=0;v<3;++v)i[c+v]=o[r+v],i[c+3+v]=o[l+v];i[c+6]=1.0001*Math.sqrt(g)+1e-4}return i}function tt(o,e,n,t,i,s,r){let a=Float64Array.from(e),[l,c,u,f]=[0,1,2,3].map(m=>Math.hypot(a[m],a[m+4],a[m+8])),{size:d,columns:p,rows:g,depths:v}=s;for(let m=0,b=0;m<r.length;++m,b+=7){let y=o[b+6],T=1/0,k=-1/0,x=1/0,I=-1/0,R=1/0;for(let B=b;B<b+6;B+=3){let L=o[B],q=o[B+1],P=o[B+2],ne=a[3]*L+a[7]*q+a[11]*P+a[15],_=ne-y*f;if(!(_>0)){R=-1/0;break}let O=(a[0]*L+a[4]*q+a[8]*P+a[12])/ne,de=(a[1]*L+a[5]*q+a[9]*P+a[13])/ne,Ee=y*(l+Math.abs(O)*f)/_+n,Te=y*(c+Math.abs(de)*f)/_+n;O-Ee<T&&(T=O-Ee),O+Ee>k&&(k=O+Ee),de-Te<x&&(x=de-Te),de+Te>I&&(I=de+Te),R=Math.min(R,(a[2]*L+a[6]*q+a[10]*P+a[14]-y*u)/_)}if(r[m]=1,R===-1/0)continue;if(k<0||T>t||I<0||x>i){r[m]=0;continue}let $=Math.max(Math.floor(T/d),0),he=Math.min(Math.floor(k/d),p-1),Q=Math.max(Math.floor(x/d),0),ee=Math.min(Math.floor(I/d),g-1);if((he-$+1)*(ee-Q+1)>256)continue;R-=1e-6;let te=!0;for(let B=Q;B<=ee&&te;++B)for(let L=$;L<=he;++L)if(R<=v[4*(B*p+L)]){te=!1;break}te&&(r[m]=0)}}function Ne({at:o,size:e},n){return[0,1,2].map(t=>(n[t]-o[t])/Math.max(e[t],1e-9))}function nt({ball:o},e,n){let t=K(n,e);if(o){let r=Math.min(1,Math.max(0,-U(e,t)/(U(t,t)||1))),a=[e[0]+r*t[0],e[1]+r*t[1],e[2]+r*t[2]];return U(a,a)<=1}let i=0,s=1;for(let r=0;r<3;++r){if(t[r]===0){if(Math.abs(e[r])>1)return!1;continue}let a=(-1-e[r])/t[r],l=(1-e[r])/t[r];i=Math.max(i,Math.min(a,l)),s=Math.min(s,Math.max(a,l))}return i<=s}function it({ball:o,at:e,size:n}){let t=(s,r,a)=>[e[0]+s*n[0],e[1]+r*n[1],e[2]+a*n[2]];if(o){let s=Array.from({length:49},(r,a)=>[Math.cos(a*Math.PI/24),Math.sin(a*Math.PI/24)]);return[s.map(([r,a])=>t(r,a,0)),s.map(([r,a])=>t(r,0,a)),s.map(([r,a])=>t(0,r,a))]}let i=s=>[t(-1,-1,s),t(1,-1,s),t(1,1,s),t(-1,1,s),t(-1,-1,s)];return[i(-1),i(1),...[[-1,-1],[1,-1],[1,1],[-1,1]].map(([s,r])=>[t(s,r,-1),t(s,r,1)])]}var G=4096,se=class extends Error{};function kt(o,e){return(e.includes("SPRITES")?Fe[o].replace("const bool SPRITES=false","const bool SPRITES=true"):Fe[o]).replace(/#define FEATURE_(\w+) [01]/g,(t,i)=>`#define FEATURE_${i} ${e.includes(i)?1:0}`)}var oe=class{constructor(e,n,t,i=[],s=[]){h(this,"gl",e);h(this,"handle");h(this,"places",new Map);h(this,"units",new Map);this.handle=e.createProgram();let r=[[e.VERTEX_SHADER,n],[e.FRAGMENT_SHADER,t]].map(([a,l])=>{let c=e.createShader(a);return e.shaderSource(c,kt(l,i)),e.compileShader(c),e.attachShader(this.handle,c),[l,c]});if(s.length&&e.transformFeedbackVaryings(this.handle,s,e.INTERLEAVED_ATTRIBS),e.linkProgram(this.handle),!e.getProgramParameter(this.handle,e.LINK_STATUS)&&!e.isContextLost()){let a=r.map(([l,c])=>`${l}: ${e.getShaderInfoLog(c)}`).join("; ");throw new se(`This browser's graphics cannot run the page's programs: ${e.getProgramInfoLog(this.handle)} ${a}`)}Object.keys(me).forEach((a,l)=>{let c=e.getUniformBlockIndex(this.handle,a);c!==e.INVALID_INDEX&&e.uniformBlockBinding(this.handle,c,l)})}use(){return this.gl.useProgram(this.handle),this}at(e){return this.places.has(e)||this.places.set(e,this.gl.getUniformLocation(this.handle,e)),this.places.get(e)}set(e){let n=this.gl;for(let[t,i]of Object.entries(e)){let s=this.at(t);s!==null&&(typeof i=="number"?n.uniform1f(s,i):i.length===2?n.uniform2fv(s,i):i.length===3?n.uniform3fv(s,i):i.length===4?n.uniform4fv(s,i):i.length===9?n.uniformMatrix3fv(s,!1,i):n.uniformMatrix4fv(s,!1,i))}return this}ints(e){for(let[n,t]of Object.entries(e)){let i=this.at(n);i!==null&&this.gl.uniform1i(i,t)}return this}uints(e){for(let[n,t]of Object.entries(e)){let i=this.at(n);i!==null&&this.gl.uniform1ui(i,t)}return this}textures(e){let n=this.gl;for(let[t,i]of Object.entries(e)){let s=this.at(t);if(s===null)continue;this.units.has(t)||this.units.set(t,this.units.size);let r=this.units.get(t);n.activeTexture(n.TEXTURE0+r),n.bindTexture(n.TEXTURE_2D,i),n.uniform1i(s,r)}return this}},Ge={r8ui:["R8UI","RED_INTEGER","UNSIGNED_BYTE",1,Uint8Array],r16ui:["R16UI","RED_INTEGER","UNSIGNED_SHORT",1,Uint16Array],r32ui:["R32UI","RED_INTEGER","UNSIGNED_INT",1,Uint32Array],rg32ui:["RG32UI","RG_INTEGER","UNSIGNED_INT",2,Uint32Array],rgba32ui:["RGBA32UI","RGBA_INTEGER","UNSIGNED_INT",4,Uint32Array],rgba8:["RGBA8","RGBA","UNSIGNED_BYTE",4,Uint8Array]};function rt(o){for(let e of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])o.texParameteri(o.TEXTURE_2D,o[e],o.NEAREST);for(let e of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])o.texParameteri(o.TEXTURE_2D,o[e],o.CLAMP_TO_EDGE)}function be(o,e,n,t){let[i]=Ge[e],s=Math.max(1,Math.ceil(n/G)),r=o.getParameter(o.MAX_TEXTURE_SIZE);if(s>r)throw new se(`The ${t} have ${n} texels; this device's textures hold ${r*G}. Make a page of fewer streamlines.`);let a=o.createTexture();return o.bindTexture(o.TEXTURE_2D,a),rt(o),o.texStorage2D(o.TEXTURE_2D,1,o[i],G,s),a}function ae(o,e,n,t,i,s){let[,r,a,l,c]=Ge[n],u=G*l,f=Math.floor(t.length/u),d=Math.ceil(s/G);o.bindTexture(o.TEXTURE_2D,e),o.pixelStorei(o.UNPACK_ALIGNMENT,1);for(let p=Math.floor(i/G);p<Math.min(f,d);p+=256){let g=Math.min(256,f-p,d-p);o.texSubImage2D(o.TEXTURE_2D,0,0,p,G,g,o[r],o[a],t.subarray(p*u,(p+g)*u))}if(d>f){let p=new c(u);p.set(t.subarray(f*u)),o.texSubImage2D(o.TEXTURE_2D,0,0,f,G,1,o[r],o[a],p)}}function Y(o,e,n,t){let i=Math.ceil(n.length/Ge[e][3]),s=be(o,e,i,t);return ae(o,s,e,n,0,i),s}function Le(o,e,n,t){let i=e.length/4-3,[s,r]=t?n.map(a=>Math.log10(a)):n;return[Y(o,"rgba8",e,"colours"),[s,r,i/Math.max(r-s,1e-30),i]]}function J(o,e,n,t){let i=o.createTexture();return o.bindTexture(o.TEXTURE_2D,i),rt(o),o.texStorage2D(o.TEXTURE_2D,1,e,n,t),i}function j(o,e,n){let t=o.createFramebuffer();return o.bindFramebuffer(o.FRAMEBUFFER,t),o.framebufferTexture2D(o.FRAMEBUFFER,o.COLOR_ATTACHMENT0,o.TEXTURE_2D,e,0),n&&o.framebufferTexture2D(o.FRAMEBUFFER,o.DEPTH_ATTACHMENT,o.TEXTURE_2D,n,0),t}var C=class{constructor(e,n){h(this,"gl",e);h(this,"name",n);h(this,"bytes");h(this,"floats");h(this,"words");h(this,"buffer");h(this,"binding");this.bytes=new ArrayBuffer(me[n].bytes),this.floats=new Float32Array(this.bytes),this.words=new Uint32Array(this.bytes),this.buffer=e.createBuffer(),this.binding=Object.keys(me).indexOf(n),e.bindBuffer(e.UNIFORM_BUFFER,this.buffer),e.bufferData(e.UNIFORM_BUFFER,this.bytes.byteLength,e.DYNAMIC_DRAW)}write(e,n=[]){for(let[t,i]of Object.entries(e)){let s=me[this.name].fields[t]/4,r=n.includes(t)?this.words:this.floats;typeof i=="number"?r[s]=i:r.set(i,s)}this.upload()}fill(e){new Uint8Array(this.bytes).set(e),this.upload()}upload(){this.gl.bindBuffer(this.gl.UNIFORM_BUFFER,this.buffer),this.gl.bufferSubData(this.gl.UNIFORM_BUFFER,0,new Uint8Array(this.bytes))}bind(){this.gl.bindBufferBase(this.gl.UNIFORM_BUFFER,this.binding,this.buffer)}};var Bt=1024,we=16,Lt=16,Mt=.1,St=[4,8,11,15],st=0,Dt=3;function ot(o,e,n,t){if(!o||!(o.data instanceof Uint32Array)||o.data.length!==n*t)throw new A(`The file's ${e} do not fit its header. Copy or make it again.`);return o.data}function le(o){let e=Math.ceil(o.byteLength/4);if(o.byteOffset%4===0&&o.byteOffset+4*e<=o.buffer.byteLength)return new Uint32Array(o.buffer,o.byteOffset,e);let n=new Uint8Array(4*e);return n.set(new Uint8Array(o.buffer,o.byteOffset,o.byteLength)),new Uint32Array(n.buffer)}function at(o,e){return e===8?o:new Uint16Array(o.slice().buffer)}var Me=class{constructor(e,n){h(this,"gl",e);h(this,"archive",n);h(this,"blocks",[]);h(this,"streamlines");h(this,"points");h(this,"bounds");h(this,"reference");h(this,"toData");h(this,"coding");h(this,"budget",256<<20);h(this,"parameters");h(this,"decodeProgram",null);h(this,"rotationBlock");h(this,"frameForDecoding");h(this,"textures",{});h(this,"itemBuffer");h(this,"toItems");h(this,"feedback");h(this,"scratch",null);h(this,"scratchBytes",0);h(this,"share",15);h(this,"itemBytes",15*we);h(this,"kinds",new Set);h(this,"table");h(this,"done",0);h(this,"shares",0);h(this,"before",0);h(this,"open",null);h(this,"growing",{});h(this,"values",[]);h(this,"held",0);h(this,"clock",0);h(this,"fiblets");h(this,"decodeArray");h(this,"indices",null);h(this,"arrays",[null,null]);let{header:t,arrays:i}=n;if(t.format!=="fiblets")throw new A("The file is no .fiblets file: its header says something else.");if(t.version!==2)throw new A(`The file is of version ${t.version}; this page reads version 2. Make the page again with a newer pvfiblets.`);let s=this.parameters=t.parameters,r=this.fiblets=t.n_fiblets;this.streamlines=t.n_streamlines,this.points=t.n_points,this.bounds=t.bounds;let a=ot(i.get("anchors.npy"),"anchors",2,r),l=ot(i.get("decoding.npy"),"records",3,r),c=i.get("codes.npy"),u=i.get("pages.npy");if(!c||!(c.data instanceof Uint8Array)||!u||!(u.data instanceof BigInt64Array))throw new A("The file's codes or pages are missing. Copy or make it again.");let f=this.table=Array.from(u.data,Number),d=Math.ceil(r/(1<<ie));if(f.length!==3*(d+1)||f[3*d+1]!==c.data.length||f[3*d+2]!==this.points)throw new A("The file's table of pages does not fit its records. Copy or make it again.");let p=s.anchor_bits===32?i.get("anchors_low.npy"):void 0;if(s.anchor_bits===32&&!(p?.data instanceof Uint16Array&&p.data.length===3*r))throw new A("The lower halves of the file's anchors are missing. Copy or make it again.");let g=s.anchor_bits===32?4294967295:65535;this.reference=[0,1,2].map(m=>{let b=(this.bounds[2*m]+this.bounds[2*m+1])/2,y=s.anchor_scale[m];return y>0&&Number.isFinite(b)?Math.round(Math.min(Math.max((b-s.origin[m])/y,0),g)):0}),this.toData=new Float64Array([1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]);for(let m=0;m<3;++m)this.toData[12+m]=s.origin[m]+s.anchor_scale[m]*this.reference[m];this.grow("anchor_texels","rg32ui",a,"anchors"),this.grow("decoding_texels","r32ui",l,"records"),this.grow("code_texels","r32ui",le(c.data),"codes"),p&&this.grow("anchor_low_texels","r32ui",le(p.data),"anchors");let v=new Uint32Array(4*Math.max(d,1));for(let m=0;m<d;++m)for(let b=0;b<3;++b)v[4*m+b]=f[3*m+b];this.textures.page_texels=Y(e,"rgba32ui",v,"pages"),this.coding=new C(e,"Coding"),this.coding.write({anchor_scale:s.anchor_scale,radius_scale:0,step_low:s.step_lo,step_span:s.step_hi-s.step_lo,lattice_edge:s.lattice,end_vector_scale:0,rotation_scales:je}),this.rotationBlock=new C(e,"Rotations"),this.rotationBlock.fill(Ze),this.frameForDecoding=new C(e,"Frame"),this.frameForDecoding.write({reference:this.reference},["reference"]),this.feedback=e.createTransformFeedback(),this.decodeArray=e.createVertexArray(),e.bindVertexArray(this.decodeArray),e.enableVertexAttribArray(0),e.bindVertexArray(null)}grow(e,n,t,i){let s=this.textures[e]=be(this.gl,n,n==="rg32ui"?t.length/2:t.length,i);this.growing[e]={texture:s,format:n,data:t}}fill(e,n,t){let i=this.growing[e];i&&ae(this.gl,i.texture,i.format,i.data,n,t)}sharesOf(e,n=this.share){let t=M("last",this.growing.decoding_texels.data[3*e+2])+1,i=this.growing.anchor_texels.data[2*e+1]>>>31;return t%n===0&&!i?t/n:Math.ceil((t+(i?1:2))/n)}begin(e){let n=this.gl,i=St.map(l=>{let c=0,u=0;for(let f=0;f<e;++f){let d=this.sharesOf(f,l);c+=d*l*(1+.05*d),u+=d}return{share:l,cost:c,total:u}}).reduce((l,c)=>c.cost<l.cost?c:l),s=this.fiblets-e;this.share=i.share,this.itemBytes=this.share*we;let r=this.points;for(let l=0;l<e;++l)r-=M("last",this.growing.decoding_texels.data[3*l+2])+1;let a=Math.max(i.total+Math.floor((Math.max(r,0)+(this.share+1)*s)/this.share),1);this.toItems=new Uint32Array(4*a),this.textures.items=be(n,"rgba32ui",a,"shares of fiblets"),this.itemBuffer=n.createBuffer(),n.bindBuffer(n.ARRAY_BUFFER,this.itemBuffer),n.bufferData(n.ARRAY_BUFFER,8*a,n.STATIC_DRAW)}advance(e){let n=this.gl,t=this.done,i=Math.min(e,this.fiblets),s=this.parameters,{table:r}=this;if(i<=t&&this.fiblets)return;t||this.begin(i);let a=this.archive.arrays.get("rank_to_id.npy")?.data,l=this.archive.arrays.get("anchors_low.npy")?.data,c=this.growing.anchor_texels.data,u=this.growing.decoding_texels.data,f=this.toItems,d=r[r.length-2],p=this.shares,g=2*s.largest_radius,v=this.kinds.size,m=p,b=this.open,y=0;for(let x=t;x<i;++x)y+=this.sharesOf(x);let T=new Uint32Array(2*y),k=()=>{b&&(b.more=1,this.blocks.push(b))};for(let x=t;x<i;++x){let I=3*(x>>ie),R=c[2*x+1],$=u[3*x+2],he=M("rank",R)+r[I],Q=M("last",$)+1,ee=a?Number(a[he]):he,te=M("begin",R),B=M("end",R),L=M("code",u[3*x+1])+r[I+1],q=M("point",$)+r[I+2],P=this.sharesOf(x);if(Q>60||4*(m+P)>f.length||!(ee>=0&&ee<this.streamlines)||L>d||q+Q>this.points)throw new A(`Record ${x} of the file is damaged. Copy or make it again.`);this.kinds.add(M("kind",$)),x%Bt===0&&(k(),b={firstItem:m,items:0,more:0,bounds:[1/0,-1/0,1/0,-1/0,1/0,-1/0],buffer:null,used:0,shapes:null,likely:null,likelies:0});let ne=[c[2*x]&65535,c[2*x]>>>16,R&65535];for(let _=0;_<3;++_){let O=s.origin[_]+s.anchor_scale[_]*(l?ne[_]*65536+l[3*x+_]:ne[_]);b.bounds[2*_]=Math.min(b.bounds[2*_],O-g),b.bounds[2*_+1]=Math.max(b.bounds[2*_+1],O+g)}te&&(this.before=0);for(let _=0;_<P;++_,++m)f[4*m]=ee,f[4*m+1]=q,f[4*m+2]=Q|te<<6|B<<7|_<<8,f[4*m+3]=this.before,T[2*(m-p)]=x,T[2*(m-p)+1]=_;this.before+=Q,b.items+=P}this.open=b,i===this.fiblets&&b&&this.blocks.push(b),this.shares=m,this.done=i,this.kinds.size>v&&(this.decodeProgram=null),ae(n,this.textures.items,"rgba32ui",f,p,m),n.bindBuffer(n.ARRAY_BUFFER,this.itemBuffer),n.bufferSubData(n.ARRAY_BUFFER,8*p,T),this.fill("anchor_texels",t,i),this.fill("decoding_texels",3*t,3*i),this.fill("anchor_low_texels",Math.floor(1.5*t),Math.ceil(1.5*i)),this.fill("code_texels",this.countBefore(t,1)>>2,this.countBefore(i,1)+3>>2);for(let{texture:x,format:I,data:R}of this.values)ae(n,x,I,R,this.countBefore(t,2),this.countBefore(i,2))}countBefore(e,n){return this.table[3*Math.ceil(e/(1<<ie))+n]}pointValues(e){let n=this.archive.header.per_point?.[e],t=n&&this.archive.arrays.get(n.member);if(!t||t.data.length!==this.points)throw new A(`The file has no values ${e} for its points.`);return this.codedValues(e,t.data,n)}codedValues(e,n,{lo:t,hi:i}){if(n.length!==this.points)throw new A(`The values ${e} are not those of the file's points.`);let s=n instanceof Uint16Array,r=s?65535:255,a=s?"r16ui":"r8ui",l=be(this.gl,a,this.points,"values of points");return this.values.push({texture:l,format:a,data:n}),ae(this.gl,l,a,n,0,this.countBefore(this.done,2)),{name:e,texture:l,code:[t,(i-t)/(r-1),r]}}forget({texture:e}){this.values=this.values.filter(n=>n.texture!==e),this.gl.deleteTexture(e)}decoder(){let e=["DIRECTION"];return this.textures.anchor_low_texels&&e.push("ANCHORS_LOW"),(this.kinds.size>1||!this.kinds.has(st))&&e.push("LATTICE"),this.kinds.has(Dt)&&e.push("WIDE_LATTICE"),this.decodeProgram??(this.decodeProgram=new oe(this.gl,"page/decode.vert","page/none.frag",e,Array.from({length:this.share},(n,t)=>`o${t}`)))}decode(e,n){let t=this.gl,i=e.items+e.more;this.coding.bind(),this.rotationBlock.bind(),this.frameForDecoding.bind();let{items:s,...r}=this.textures;this.decoder().use().textures(r).uints({chunk_fiblets:this.fiblets,share_size:this.share}),t.bindVertexArray(this.decodeArray),t.bindBuffer(t.ARRAY_BUFFER,this.itemBuffer),t.vertexAttribIPointer(0,2,t.UNSIGNED_INT,8,8*e.firstItem),t.bindBuffer(t.ARRAY_BUFFER,null),t.enable(t.RASTERIZER_DISCARD),t.bindTransformFeedback(t.TRANSFORM_FEEDBACK,this.feedback),t.bindBufferRange(t.TRANSFORM_FEEDBACK_BUFFER,0,n,0,i*this.itemBytes),t.beginTransformFeedback(t.POINTS),t.drawArrays(t.POINTS,0,i),t.endTransformFeedback(),t.bindBufferBase(t.TRANSFORM_FEEDBACK_BUFFER,0,null),t.bindTransformFeedback(t.TRANSFORM_FEEDBACK,null),t.disable(t.RASTERIZER_DISCARD),t.bindVertexArray(null)}size(e){return(e.items+e.more)*this.itemBytes+2*we}newBuffer(e){let n=this.gl,t=n.createBuffer();return n.bindBuffer(n.ARRAY_BUFFER,t),n.bufferData(n.ARRAY_BUFFER,e,n.DYNAMIC_COPY),n.bindBuffer(n.ARRAY_BUFFER,null),t}pointsOf(e){if(e.used=++this.clock,e.buffer)return e.buffer;let n=this.size(e);return this.held+n<=this.budget?(this.held+=n,e.buffer=this.newBuffer(n),this.decode(e,e.buffer),e.buffer):(this.scratchBytes<n&&(this.scratch&&this.gl.deleteBuffer(this.scratch),this.scratch=this.newBuffer(this.scratchBytes=n)),this.decode(e,this.scratch),this.scratch)}get items(){return this.textures.items}segments(e){return e*this.share}get longestStep(){return this.kinds.size===1&&this.kinds.has(st)?2*this.parameters.step_hi:1/0}draw(e,n,t,i){return this.drawRun(e,n,0,Math.max(1,Math.round(t)),i)}drawRun(e,n,t,i,s){let r=this.gl,a=(i-t)*this.share;return this.aim(e,n,t,s),s?r.drawArrays(r.POINTS,0,a):r.drawArraysInstanced(r.TRIANGLE_STRIP,0,4,a),r.bindVertexArray(null),a}aim(e,n,t,i){let s=this.gl,r=this.pointsOf(e);n.use().ints({first_item:e.firstItem+t,share_size:this.share}),s.bindVertexArray(this.segmentArray(i)),s.bindBuffer(s.ARRAY_BUFFER,r);for(let a=0;a<3;++a)s.vertexAttribIPointer(a,4,s.UNSIGNED_INT,we,t*this.itemBytes+a*we)}likely(e){return e.likely||(e.likely=new Uint8Array(e.items).fill(1,0,e.likelies=Math.max(1,Math.round(Mt*e.items)))),e.likely}look(e,n,t,i,s,r){let a=new Uint8Array(e.items),l=this.likely(e),c=new Uint8Array(e.items);tt(e.shapes??(e.shapes=this.shapesOf(e)),n,t,i,s,r,a),e.likelies=0;for(let u=0;u<c.length;++u)c[u]=a[u]&~l[u],e.likelies+=a[u];return e.likely=a,c}shapesOf(e){let n=this.toItems,{share:t}=this;return et(this.slotsOf(e),e.items,t,i=>{let s=n[4*(e.firstItem+i)+2],r=s>>>7&1,a=s&63;return Math.min(a+1-r-t*(s>>>8),t+1)})}slotsOf(e){let n=this.gl,t=new Float32Array((e.items+e.more+1)*this.share*4);return n.bindBuffer(n.ARRAY_BUFFER,this.pointsOf(e)),n.getBufferSubData(n.ARRAY_BUFFER,0,t,0,(e.items+e.more)*this.share*4),n.bindBuffer(n.ARRAY_BUFFER,null),t}drawSome(e,n,t,i,s=1/0){let r=this.gl,{share:a}=this,l=0;if(!i){let f=0,d=0;for(let p=0;p<t.length&&d<s;++p){if(!t[p])continue;let g=p+1;++d;for(let v=g;v<Math.min(t.length,g+Lt)&&d<s;++v)t[v]&&(g=v+1,++d);f+=this.drawRun(e,n,p,g,i),p=g}return f}let c=Math.min(s,t.length),u=new Uint32Array(c*a);for(let f=0,d=0;f<t.length&&d<c;++f){if(!t[f])continue;let p=this.toItems[4*(e.firstItem+f)+2],g=p&63,v=g-((p&128)!==0&&g>1?1:0);for(let m=f*a,b=m+Math.min(v-a*(p>>>8),a);m<b;++m)u[l++]=m;++d}return l?(this.aim(e,n,0,i),r.bindBuffer(r.ELEMENT_ARRAY_BUFFER,this.indices??(this.indices=r.createBuffer())),r.bufferData(r.ELEMENT_ARRAY_BUFFER,u.subarray(0,l),r.STREAM_DRAW),r.drawElements(r.POINTS,l,r.UNSIGNED_INT,0),r.bindVertexArray(null),l):0}segmentArray(e){let n=e?1:0;if(!this.arrays[n]){let t=this.gl;t.bindVertexArray(this.arrays[n]=t.createVertexArray());for(let i=0;i<3;++i)t.enableVertexAttribArray(i),t.vertexAttribDivisor(i,e?0:1)}return this.arrays[n]}*decoded(e,n=0){let t=this.toItems;for(let i of this.blocks.slice(n)){if(!e(i))continue;let s=this.slotsOf(i);for(let r=i.firstItem;r<i.firstItem+i.items;++r){if(t[4*r+2]>>>8)continue;let a=t[4*r+2]&63,l=(t[4*r+2]&128)!==0,c=4*this.share*(r-i.firstItem);yield[t[4*r],s.subarray(c,c+4*(a+(l?0:1))),(t[4*r+2]&64)!==0]}}}blocksOf(e){let n=this.toItems;return t=>{for(let i=t.firstItem;i<t.firstItem+t.items;++i)if(n[4*i]===e)return!0;return!1}}world(e,n){return[0,1,2].map(t=>this.toData[12+t]+e[4*n+t])}pointsOfStreamline(e){let n=[];for(let[t,i]of this.decoded(this.blocksOf(e)))if(t===e)for(let s=0;4*s<i.length;++s)n.push(this.world(i,s));return n}through(e,n,t=0,i=new Uint8Array(this.streamlines)){let{at:s,size:r}=e,a=({bounds:l})=>{let c=[0,1,2,3,4,5,6,7].map(u=>F(n,[l[u&1],l[2+(u>>1&1)],l[4+(u>>2)]]));return[0,1,2].every(u=>c.some(f=>f[u]>=s[u]-r[u])&&c.some(f=>f[u]<=s[u]+r[u]))};for(let[l,c]of this.decoded(a,t)){if(i[l])continue;let u=Ne(e,F(n,this.world(c,0)));for(let f=0;f<c.length&&!i[l];f+=4){let d=Ne(e,F(n,this.world(c,Math.min(f+4,c.length-4)/4)));nt(e,u,d)&&(i[l]=1),u=d}}return i}release(){let e=this.gl;for(let n of this.blocks)n.buffer&&e.deleteBuffer(n.buffer);for(let n of Object.values(this.textures))e.deleteTexture(n);for(let n of[this.scratch,this.indices,this.itemBuffer])n&&e.deleteBuffer(n)}};var lt="http://www.w3.org/2000/svg";function w(o,e={},...n){let t=document.createElement(o);for(let[i,s]of Object.entries(e))t.setAttribute(i,s);return t.append(...n),t}var V=o=>Number.isFinite(o)?String(Number(o.toPrecision(4))):"no value";function S(o,e,n,t,i){let s=(n-e)/200||1,r=w("output",{},V(t)),a=w("input",{type:"range",min:String(e),max:String(n),step:String(s),value:String(t)});return a.addEventListener("input",()=>{r.textContent=V(a.valueAsNumber),i(a.valueAsNumber)}),w("label",{},w("span",{},o),a,r)}function Se(o,e,n){let t=w("input",{type:"checkbox"});return t.checked=e,t.addEventListener("change",()=>n(t.checked)),w("label",{},t,w("span",{},o))}function ce(o,e){let n=w("button",{type:"button"},o);return n.addEventListener("click",e),n}function Z(o,...e){return w("fieldset",{},w("legend",{},o),...e)}var Ut=[["Left",[1,0,0],[0,0,1]],["Right",[-1,0,0],[0,0,1]],["Front",[0,-1,0],[0,0,1]],["Back",[0,1,0],[0,0,1]],["Top",[0,0,-1],[0,1,0]],["Bottom",[0,0,1],[0,1,0]]];function Ct(o){let e=D(o.table),n=e.length/4,t=w("canvas",{width:String(n),height:"1",role:"img","aria-label":`Colours from ${V(o.clim[0])} to ${V(o.clim[1])}`}),i=t.getContext("2d"),s=i.createImageData(n,1);if(s.data.set(e),i.putImageData(s,0,0),o.labels){let c=o.labels.map(({name:u,colour:f})=>{let d=w("i",{"aria-hidden":"true"});return d.style.background=`rgb(${f.join(",")})`,w("li",{},d,u)});return w("figure",{class:"bar"},w("figcaption",{},o.title),w("ul",{tabindex:"0","aria-label":o.title},...c))}let[r,a]=o.clim,l=o.log?Math.sqrt(r*a):(r+a)/2;return w("figure",{class:"bar"},w("figcaption",{},o.title),t,w("div",{class:"ticks","aria-hidden":"true"},...[r,l,a].map(c=>w("span",{},V(c)))))}var De=class{constructor(e,n){h(this,"renderer",e);h(this,"data",n);h(this,"told",null);h(this,"status",document.getElementById("status"));h(this,"axes",[]);h(this,"choices",new Map);h(this,"picked",null);h(this,"regions",[]);h(this,"outlines",document.createElementNS(lt,"svg"));h(this,"later",0);let t=document.getElementById("over"),{scene:i}=e,s=w("details",{id:"panel"},w("summary",{},"Scene"));s.append(this.layers(),...this.groups(),this.views(),this.cut(),...this.ranges(),this.regionList()),t.append(this.outlines,s),i.bars.length&&t.append(w("div",{id:"bars"},...i.bars.map(Ct))),t.append(this.orientation()),e.restored=()=>{for(let r of this.choices.values())r.apply()},e.presented=()=>this.follow(),e.grown=()=>this.grown(),this.follow()}layers(){let{renderer:e}=this,n=[];return e.scene.layers.forEach(t=>{n.push(Se(t.name,t.visible,i=>{t.visible=i,e.change()})),t.kind==="fiblets"?n.push(S("Line width",.5,10,t.line_width,i=>{t.line_width=i,e.change(!0)})):n.push(S("Opacity",0,1,t.opacity,i=>{t.opacity=i,e.change(!0)}))}),Z("Shown",...n)}views(){let{renderer:e}=this,n=structuredClone(e.camera.state),t=Ut.map(([i,s,r])=>ce(i,()=>{e.camera.lookAlong(s,r,e.scene.bounds),e.change()}));return t.push(ce("As at first",()=>{Object.assign(e.camera.state,structuredClone(n)),e.change()})),t.push(ce("Save picture",()=>this.save())),Z("View",w("div",{class:"buttons"},...t))}save(){let{renderer:e}=this;e.settled().then(()=>{let n=w("canvas",{width:String(e.width),height:String(e.height)}),t=n.getContext("2d"),i=t.createImageData(e.width,e.height);i.data.set(e.pixels()),t.putImageData(i,0,0),n.toBlob(s=>{let r=w("a",{href:URL.createObjectURL(s),download:"picture.png"});r.click(),setTimeout(()=>URL.revokeObjectURL(r.href),6e4)})})}cut(){let{renderer:e}=this,n=e.scene.bounds,t=w("select",{"aria-label":"Cut across"});for(let l of["nothing","left to right","back to front","bottom to top"])t.append(w("option",{},l));let i=w("div"),s=0,r=0,a=()=>{let l=t.selectedIndex-1,c=u=>[0,1,2].map(f=>f===l?u:0).concat(-u*s+r/2);e.planes=l<0?[]:[c(1),c(-1)],e.change(!0)};return t.addEventListener("change",()=>{let l=t.selectedIndex-1;if(i.replaceChildren(),l>=0){let c=n[2*l],u=n[2*l+1];s=(c+u)/2,r=(u-c)/8,i.append(S("Middle",c,u,s,f=>{s=f,a()}),S("Thickness",(u-c)/200,u-c,r,f=>{r=f,a()}))}a()}),Z("Slab across",t,i)}choiceOf(e){let n=this.choices.get(e.index);return n||this.choices.set(e.index,n=new Be(e,e.layer.kept===void 0?null:this.data[e.layer.kept])),n}ranges(){let{renderer:e}=this,n=[];for(let t of e.lines){let{values:i,layer:s}=t;if(i){let r=i.code[0],a=r+i.code[1]*(i.code[2]-1),l=[r,a],c=()=>{e.lines[t.index].shownValues=l[0]>r||l[1]<a?[l[0],l[1]]:[1,0],e.change(!0)};n.push(Z(i.name,S("From",r,a,r,u=>{l[0]=u,c()}),S("To",r,a,a,u=>{l[1]=u,c()})))}for(let r of s.controls??[]){if(r.data===void 0)continue;let a=this.data[r.data],l=new Float32Array(a.slice().buffer),[c,u]=r.range,f=d=>p=>{this.choiceOf(e.lines[t.index]).set(r,l,d,p),e.change(!0)};n.push(Z(r.name,S("From",c,u,c,f(0)),S("To",c,u,u,f(1))))}}return n}groups(){return this.renderer.lines.filter(({layer:e})=>e.groups?.length).map(e=>{let n=this.choiceOf(e),t=e.layer.groups.map(({name:i,data:s})=>{let r=le(this.data[s]);return n.groups.push(r),Se(i,!0,a=>{a?n.hidden.delete(r):n.hidden.add(r),n.apply(),this.renderer.change()})});return Z(`Groups of ${e.layer.name}`,...t)})}regionList(){let e=w("div"),{renderer:n}=this,t=n.scene.bounds,i=Math.hypot(t[1]-t[0],t[3]-t[2],t[5]-t[4]),s=r=>()=>{let a=this.picked?F(this.picked.lines.model,this.picked.place).slice(0,3):[0,1,2].map(c=>(t[2*c]+t[2*c+1])/2),l={ball:r,at:a,size:[i/40,i/40,i/40],on:!0,inverted:!1};this.regions.push(l),e.append(this.regionRow(l,i)),this.update(l)};return Z("Regions",w("div",{class:"buttons"},ce("Add a ball",s(!0)),ce("Add a box",s(!1))),e)}regionRow(e,n){let{renderer:t}=this,i=t.scene.bounds,s=`${e.ball?"Ball":"Box"} ${this.regions.length}`,r=()=>{window.clearTimeout(this.later),this.later=window.setTimeout(()=>this.update(e),120),this.drawOutlines()},a=(c,u)=>S(c,n/1e3,n/4,e.size[u[0]],f=>{for(let d of u)e.size[d]=f;r()}),l=w("details",{},w("summary",{},s),Se("On",!0,c=>{e.on=c,this.choose()}),Se("Streamlines outside it",!1,c=>{e.inverted=c,this.choose()}),...["x","y","z"].map((c,u)=>S(`${c}, mm`,i[2*u],i[2*u+1],e.at[u],f=>{e.at[u]=f,r()})),...e.ball?[a("Radius, mm",[0,1,2])]:["x","y","z"].map((c,u)=>a(`Half of ${c}, mm`,[u])),w("div",{class:"buttons"},ce(`Remove ${s.toLowerCase()}`,()=>{l.remove(),this.regions.splice(this.regions.indexOf(e),1);for(let c of this.choices.values())c.regions.delete(e);this.choose()})));return l.open=!0,l}update(e){if(this.regions.includes(e)){for(let n of this.renderer.lines)this.choiceOf(n).look(e,!1);this.choose()}}grown(){if(this.regions.length){for(let e of this.choices.values())for(let n of this.regions)e.look(n,!0);this.choose()}}choose(){let e=0;this.drawOutlines();for(let n of this.choices.values())n.apply(),e+=n.count;this.status.textContent=this.regions.some(n=>n.on)?`${e} streamlines are shown`:"",this.renderer.change()}pick(e,n){let{renderer:t}=this,i=t.pick(e,n);if(this.unmark(),i){let{lines:s,streamline:r,value:a}=i,l=t.placeOf(s,r,e,n),c=F(s.model,l).slice(0,3);this.say(s,r,a,c),this.picked={lines:s,streamline:r,place:l},this.told?.({layer:t.scene.layers.indexOf(s.layer),streamline:r,place:c})}else this.told?.(null);t.change()}mark(e){this.unmark();let n=e&&this.renderer.lines.find(({layer:t})=>t===this.renderer.scene.layers[e.layer]);if(e&&n&&e.streamline>=0&&e.streamline<n.set.streamlines){let{streamline:t}=e,i=n.set.pointsOfStreamline(t),s=i[i.length>>1];this.say(n,t,null,e.place??[]),s&&(this.picked={lines:n,streamline:t,place:s})}this.renderer.change()}unmark(){for(let e of this.renderer.lines)e.marked=4294967295;this.picked=null,this.status.textContent=""}say(e,n,t,i){e.marked=n;let s=[`Streamline ${n} of ${e.layer.name}`];t!==null&&e.values&&s.push(`${e.values.name} ${V(t)}`);for(let r of e.layer.controls??[])r.data!==void 0&&s.push(`${r.name} ${V(new Float32Array(this.data[r.data].slice().buffer)[n])}`);i.length&&s.push(`at ${i.map(V).join(", ")} mm`),this.status.textContent=s.join("; ")}orientation(){let n=(this.renderer.scene.letters?[["L","R"],["P","A"],["I","S"]]:[["","x"],["","y"],["","z"]]).flat().map((t,i)=>w("span",{class:`axis a${i>>1}`},t));return this.axes=n,w("div",{id:"axes","aria-hidden":"true"},...n)}follow(){this.turnAxes(),this.drawOutlines()}drawOutlines(){let{renderer:e,outlines:n}=this,{camera:t,canvas:i}=e,s=i.clientWidth,r=i.clientHeight;if(!this.regions.length)return n.replaceChildren();let a=E(t.projection(s/r,e.scene.bounds),t.view());n.replaceChildren(...this.regions.map(l=>{let c=document.createElementNS(lt,"path"),u=[];for(let f of it(l)){let d="M";for(let p of f){let[g,v,,m]=F(a,p);m>0&&u.push(`${d}${((g/m+1)*s/2).toFixed(1)} ${((1-v/m)*r/2).toFixed(1)}`),d=m>0?"L":"M"}}return c.setAttribute("d",u.join("")),c.setAttribute("opacity",l.on?"1":".3"),c}))}turnAxes(){let e=this.renderer.camera.view();this.axes.forEach((n,t)=>{let i=W([0,1,2].map(l=>l===t>>1?1:0),t&1?1:-1),[s,r,a]=F(e,i,0);n.style.transform=`translate(${(s*32).toFixed(1)}px, ${(-r*32).toFixed(1)}px)`,n.style.opacity=String(.35+.65*(.5+a/2))})}};function Ye(o,e=()=>{}){let{canvas:n,camera:t}=o,i=new Map,s=0,r=0;n.addEventListener("pointerdown",l=>{n.focus(),n.setPointerCapture(l.pointerId),i.set(l.pointerId,{x:l.offsetX,y:l.offsetY}),s=0,r=l.button,l.preventDefault()}),n.addEventListener("contextmenu",l=>l.preventDefault());let a=l=>{i.delete(l.pointerId)&&(l.type==="pointerup"&&s<4&&r===0&&!i.size?e(l.offsetX,l.offsetY):o.change())};n.addEventListener("pointerup",a),n.addEventListener("pointercancel",a),n.addEventListener("pointermove",l=>{let c=i.get(l.pointerId);if(!c)return;let u=l.offsetX-c.x,f=l.offsetY-c.y,d=n.clientWidth,p=n.clientHeight;if(s+=Math.abs(u)+Math.abs(f),i.size===2){let g=[...i.entries()].find(([b])=>b!==l.pointerId)[1],v=[c.x-g.x,c.y-g.y],m=[l.offsetX-g.x,l.offsetY-g.y];t.dolly(Math.hypot(m[0],m[1])/Math.max(1,Math.hypot(v[0],v[1]))),t.roll((Math.atan2(m[1],m[0])-Math.atan2(v[1],v[0]))*180/Math.PI),t.pan(u/2/p,-f/2/p)}else r===1||l.shiftKey?t.pan(u/p,-f/p):r===2?t.dolly(Math.pow(1.1,-20*.2*f/(p/2)*5)):l.ctrlKey?t.roll(180*u/d):t.rotate(u/d,-f/p);c.x=l.offsetX,c.y=l.offsetY,o.change(!0)}),n.addEventListener("wheel",l=>{t.dolly(Math.pow(1.1,Math.max(-3,Math.min(3,-l.deltaY/50)))),o.change(!0),l.preventDefault()},{passive:!1}),n.addEventListener("keydown",l=>{let u={ArrowLeft:()=>l.shiftKey?t.pan(-.04,0):t.rotate(-.04,0),ArrowRight:()=>l.shiftKey?t.pan(.04,0):t.rotate(.04,0),ArrowUp:()=>l.shiftKey?t.pan(0,.04):t.rotate(0,.04),ArrowDown:()=>l.shiftKey?t.pan(0,-.04):t.rotate(0,-.04),"+":()=>t.dolly(1.1),"=":()=>t.dolly(1.1),"-":()=>t.dolly(.9090909090909091),Enter:()=>e(n.clientWidth/2,n.clientHeight/2)};l.altKey||l.metaKey||!u[l.key]||(u[l.key](),o.change(!0),l.preventDefault())})}var Ve=o=>Array.isArray(o)&&o.length===3&&o.every(Number.isFinite);function ct(o,e){let{parent:n}=window;if(n===window)return;let t=r=>n.postMessage({pvfiblets:r},"*"),{state:i}=o.camera,s=JSON.stringify(i);window.addEventListener("message",r=>{let a=r.source===n?r.data?.pvfiblets:void 0;if(!a)return;let{camera:l,picked:c}=a;if(l&&Ve(l.position)&&Ve(l.focal_point)&&Ve(l.up)&&l.view_angle>0&&l.parallel_scale>0){Object.assign(i,l);let u=JSON.stringify(i);u!==s&&o.change(),s=u}c!==void 0&&e.mark(c)}),o.finished=()=>{let r=JSON.stringify(i);r!==s&&t({camera:JSON.parse(s=r)})},e.told=r=>t({picked:r}),t({ready:!0})}var ye=class{constructor(e,n){h(this,"file",e);h(this,"bytes");h(this,"come",0);h(this,"whole",null);h(this,"waiting",[]);h(this,"had",[]);this.bytes=new Uint8Array(n)}async need(e,n){n<=e||this.had.some(([t,i])=>t<=e&&i>=n)||(this.whole||await this.tried(e,n),this.whole&&await this.upTo(n))}async tried(e,n){for(let t=2;;--t)try{return await this.ask(e,n)}catch(i){if(!(i instanceof TypeError))throw i;if(!t)throw new Error(`${this.file} cannot be read: the connection to its server broke, or there is no server. Files beside a page need one; "python -m http.server" is enough.`);await new Promise(s=>setTimeout(s,500))}}async ask(e,n){let t=await fetch(this.file,{headers:{Range:`bytes=${e}-${n-1}`}});if(!t.ok)throw new Error(`${this.file} cannot be read (${t.status}); it must lie beside this page.`);if(t.status!==206){this.whole?t.body?.cancel():this.whole=this.flow(t);return}let i=Number(/\/(\d+)$/.exec(t.headers.get("Content-Range")??"")?.[1]??this.bytes.length),s=new Uint8Array(await t.arrayBuffer());if(i!==this.bytes.length||s.length!==n-e)throw this.changed(i);this.bytes.set(s,e),this.had.push([e,n])}async flow(e){let n=e.body.getReader();for(;;){let{done:t,value:i}=await n.read();if(t)break;if(this.come+i.length>this.bytes.length)throw this.changed(this.come+i.length);this.bytes.set(i,this.come),this.come+=i.length,this.waiting=this.waiting.filter(s=>s.end<=this.come?s.resolve():!0)}if(this.come!==this.bytes.length)throw this.changed(this.come)}async upTo(e){e>this.come&&await Promise.race([this.whole,new Promise(n=>this.waiting.push({end:e,resolve:n}))])}changed(e){return new Error(`${this.file} has ${e} bytes, and this page was made with one of ${this.bytes.length}. Copy the page and its folder again.`)}};function Pt(o,e,n){let t=e.slice(0,6).map(i=>[0,1,2,3].map(s=>i[0]*n[4*s]+i[1]*n[4*s+1]+i[2]*n[4*s+2]+i[3]*n[4*s+3]));o.ints({plane_count:t.length}),t.forEach((i,s)=>o.set({[`planes[${s}]`]:i}))}var Ue=class{constructor(e,n,t){h(this,"gl",e);h(this,"layer",n);h(this,"array");h(this,"buffers",[]);h(this,"count");h(this,"table",null);h(this,"tableRange",[0,1,1,1]);h(this,"model");this.model=new Float64Array(n.matrix??[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]),this.array=e.createVertexArray(),e.bindVertexArray(this.array);let i=(r,a,l,c,u)=>{let f=e.createBuffer();e.bindBuffer(e.ARRAY_BUFFER,f),e.bufferData(e.ARRAY_BUFFER,a,e.STATIC_DRAW),e.enableVertexAttribArray(r),e.vertexAttribPointer(r,l,c,u,0,0),this.buffers.push(f)};i(0,t[n.places],3,e.FLOAT,!1),n.normals!==void 0&&i(1,t[n.normals],3,e.FLOAT,!1),n.colours!==void 0&&i(2,t[n.colours],4,e.UNSIGNED_BYTE,!0),n.values!==void 0&&(i(3,t[n.values],1,e.FLOAT,!1),[this.table,this.tableRange]=Le(e,D(n.table),n.clim,!!n.log));let s=e.createBuffer();e.bindBuffer(e.ELEMENT_ARRAY_BUFFER,s),e.bufferData(e.ELEMENT_ARRAY_BUFFER,t[n.triangles],e.STATIC_DRAW),this.buffers.push(s),this.count=t[n.triangles].byteLength/4,e.bindVertexArray(null)}get translucent(){return this.layer.opacity<1}draw(e,n){let t=this.gl,{layer:i}=this,s=E(n.view,this.model),r=ve(s),a=ge(s),l=a?[a[0],a[4],a[8],a[1],a[5],a[9],a[2],a[6],a[10]]:r;e.use().set({clip_from_data:ke(E(n.projection,s)),view_from_data:ke(s),normal_to_view:l,parallel:n.parallel?1:0,opacity:i.opacity,reflects:i.reflects,sheen:i.sheen}),e.ints({smooth_normals:i.normals===void 0?0:1,lighting:i.lighting?1:0,by_value:this.table?1:0,logarithm:i.log?1:0}),e.textures({table:this.table}).set({table_range:this.tableRange}),n.lights(e),Pt(e,[...i.planes??[],...n.planes],this.model),t.bindVertexArray(this.array),i.normals===void 0&&t.vertexAttrib3f(1,0,0,1),i.colours===void 0&&t.vertexAttrib4f(2,i.colour[0],i.colour[1],i.colour[2],1),t.drawElements(t.TRIANGLES,this.count,t.UNSIGNED_INT,0),t.bindVertexArray(null)}release(){for(let e of this.buffers)this.gl.deleteBuffer(e);this.gl.deleteVertexArray(this.array),this.table&&this.gl.deleteTexture(this.table)}depth(e){let n=this.layer.bounds,t=[(n[0]+n[1])/2,(n[2]+n[3])/2,(n[4]+n[5])/2];return-(e[2]*t[0]+e[6]*t[1]+e[10]*t[2]+e[14])}},Ce=class{constructor(e,n,t){h(this,"gl",e);h(this,"layer",n);h(this,"texture");let[i,s]=n.size;this.texture=e.createTexture(),e.bindTexture(e.TEXTURE_2D,this.texture),e.texImage2D(e.TEXTURE_2D,0,e.RGBA8,i,s,0,e.RGBA,e.UNSIGNED_BYTE,t[n.pixels]);for(let r of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])e.texParameteri(e.TEXTURE_2D,e[r],e.NEAREST);for(let r of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])e.texParameteri(e.TEXTURE_2D,e[r],e.CLAMP_TO_EDGE)}release(){this.gl.deleteTexture(this.texture)}draw(e,n){let{layer:t}=this;e.use().set({clip_from_data:ke(E(n.projection,n.view)),corner:t.corner,across:t.across,up:t.up,opacity:t.opacity}),e.textures({pixels:this.texture}),this.gl.bindVertexArray(null),this.gl.drawArrays(this.gl.TRIANGLE_STRIP,0,4)}};var Ot=60,ut=45,ft=400,zt=.5,ue=16,xe=4,Nt=40,Ae=4294967295,Gt=1065353216,Yt={direction:0,solid:1,streamline:2,value:3,point:4},Vt={none:0,line:1,illuminated:2},Qe=class{constructor(e,n,t,i,s,r){h(this,"gl",e);h(this,"layer",n);h(this,"index",t);h(this,"set");h(this,"model");h(this,"values",null);h(this,"colours",null);h(this,"table",null);h(this,"tableRange",[0,1,1,1]);h(this,"kept",null);h(this,"chosen",null);h(this,"keptPoints",null);h(this,"shownValues",[1,0]);h(this,"marked",Ae);this.set=r??new Me(e,s),this.set.advance(s.ready),this.model=new Float64Array(n.matrix??Re());let{colours:a}=n;a.codes?this.values=this.set.codedValues(a.values,at(i[a.codes.data],a.codes.bits),a.codes):a.values!==void 0&&(this.values=this.set.pointValues(a.values)),a.data!==void 0&&(this.colours=Y(e,"rgba8",i[a.data],"colours")),a.table!==void 0&&([this.table,this.tableRange]=Le(e,D(a.table),a.clim,!!a.log)),n.kept!==void 0&&this.keep(i[n.kept]),n.chosen&&(this.chosen=Y(e,"r8ui",i[n.chosen.data],"streamlines")),n.kept_points!==void 0&&(this.keptPoints=Y(e,"r32ui",le(i[n.kept_points]),"points"))}release(){this.values&&this.set.forget(this.values);for(let e of[this.colours,this.table,this.kept,this.chosen,this.keptPoints])e&&this.gl.deleteTexture(e)}get byPoint(){return this.layer.colours.mode==="point"}keep(e){this.kept&&this.gl.deleteTexture(this.kept),this.kept=e&&Y(this.gl,"r8ui",e,"streamlines")}},_e=class{constructor(e,n,t,i){h(this,"canvas",e);h(this,"scene",n);h(this,"data",t);h(this,"archives",i);h(this,"camera");h(this,"lines",[]);h(this,"surfaces",[]);h(this,"images",[]);h(this,"planes",[]);h(this,"width",0);h(this,"height",0);h(this,"ratio",1);h(this,"frames",0);h(this,"few",2e5);h(this,"loading",!1);h(this,"failed",null);h(this,"drawnOnce",null);h(this,"presented",null);h(this,"grown",null);h(this,"finished",null);h(this,"gl");h(this,"programs",new Map);h(this,"frameBlock");h(this,"clipBlock");h(this,"textures",{});h(this,"buffers",{});h(this,"frame",null);h(this,"rest",null);h(this,"sync",null);h(this,"sliceStarted",0);h(this,"sliceSize",0);h(this,"rate",1e3);h(this,"dirty",!0);h(this,"moving",!1);h(this,"asked",0);h(this,"still",0);h(this,"waiting",[]);h(this,"restored",null);this.camera=new Ie(structuredClone(n.camera));let s=e.getContext("webgl2",{alpha:!1,antialias:!1,depth:!1,preserveDrawingBuffer:!1,powerPreference:"high-performance"});if(!s)throw new se("This browser has no WebGL 2, which the page draws with. Turn on graphics acceleration in its settings, or open the page in another browser.");this.gl=s,e.addEventListener("webglcontextlost",r=>{r.preventDefault(),this.frame=this.rest=null,this.sync=null}),e.addEventListener("webglcontextrestored",()=>this.guarded(()=>this.begin())),this.begin()}guarded(e){try{e()}catch(n){this.gl.isContextLost()||this.failed?.(n)}}begin(){let{gl:e}=this,n=this.lines.splice(0);this.programs.clear(),this.rest=null,this.textures={},this.buffers={},this.width=this.height=0,this.surfaces.length=this.images.length=0,this.frameBlock=new C(e,"Frame"),this.clipBlock=new C(e,"ClipPlanes"),this.fill(new Map,new Map),n.forEach((t,i)=>{let s=this.lines[i];s.shownValues=t.shownValues,s.marked=t.marked}),this.restored?.(),this.change()}fill(e,n){let{gl:t,scene:i}=this;i.layers.forEach(r=>{r.kind==="surface"?this.surfaces.push(n.get(JSON.stringify(r))??new Ue(t,r,this.data)):r.kind==="image"?this.images.push(new Ce(t,r,this.data)):this.lines.push(new Qe(t,r,this.lines.length,this.data,this.archives.get(r.data),e.get(this.data[r.data])))});let s=Math.min(1024,128*(navigator.deviceMemory??4))*2**20;for(let r of this.lines)r.set.budget=s/this.lines.length}update(e,n,t){if(this.gl.isContextLost())return;let{data:i}=this,s=this.lines.splice(0),r=this.surfaces.splice(0),a=this.images.splice(0),l=new Map(s.map(u=>[i[u.layer.data],u.set])),c=u=>[u.layer.places,u.layer.triangles,u.layer.normals,u.layer.colours,u.layer.values].every(f=>f===void 0||i[f]===n[f]);this.frame=this.rest=null,this.scene=e,this.data=n,this.archives=t,this.fill(l,new Map(r.filter(c).map(u=>[JSON.stringify(u.layer),u])));for(let u of[...s,...a])u.release();for(let{set:u}of s)this.lines.some(f=>f.set===u)||u.release();for(let u of r)this.surfaces.includes(u)||u.release();this.change()}program(e,n,t=[]){let i=[e,n,...t].join(" "),s=this.programs.get(i);return s||this.programs.set(i,s=new oe(this.gl,e,n,t)),s}change(e=!1){this.dirty=!0,this.moving=e,window.clearTimeout(this.still),e&&(this.still=window.setTimeout(()=>this.change(),200)),this.schedule()}grow(){this.guarded(()=>{let e=this.frame??this.rest;for(let n of this.lines){let{set:t}=n,i=t.blocks.length;if(t.advance(this.archives.get(n.layer.data).ready),!e||!n.layer.visible)continue;let s=e.jobs.length;if(this.addJobs(e,n,t.blocks.slice(i)),t.segments(t.blocks.reduce((a,l)=>a+l.items,0))<=this.few)continue;let r=e.jobs.splice(s);for(let a of["likely","others"])e.jobs.push(...r.map(l=>({...l,what:a})))}e?this.dirty||(this.frame=e):this.change(),this.grown?.()}),this.schedule()}addJobs(e,n,t){let i=E(e.matrices.projection,E(e.matrices.view,n.model));for(let s of t)this.outside(i,s.bounds)||e.jobs.push({lines:n,block:s,what:"all"})}findFarTiles(e,n){let{gl:t,textures:i}=this,s=Math.ceil(this.width/xe),r=Math.ceil(this.height/xe);if(t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.far),!e)return t.clearBufferuiv(t.COLOR,0,[Gt,0,0,0]),null;if(t.disable(t.DEPTH_TEST),t.bindVertexArray(null),t.viewport(0,0,s,r),this.program("page/screen.vert","page/far_tiles.frag").use().textures({depths:i.depths}),t.drawArrays(t.TRIANGLES,0,3),t.viewport(0,0,this.width,this.height),!n)return null;let a=new Uint32Array(4*s*r);return t.readPixels(0,0,s,r,t.RGBA_INTEGER,t.UNSIGNED_INT,a),{size:xe,columns:s,rows:r,depths:new Float32Array(a.buffer)}}schedule(){let e=()=>this.guarded(()=>this.tick());this.asked||(this.asked=this.sync&&this.frame&&!this.frame.moving?window.setTimeout(e,1):requestAnimationFrame(e))}settled(){return!this.dirty&&!this.frame&&!this.loading?Promise.resolve():new Promise(e=>this.waiting.push(e))}tick(){this.asked=0;let{gl:e}=this;if(e.isContextLost())return;if(this.sync){if(e.getSyncParameter(this.sync,e.SYNC_STATUS)!==e.SIGNALED)return this.schedule();e.deleteSync(this.sync),this.sync=null;let s=Math.max(performance.now()-this.sliceStarted,.5);this.sliceSize>2e3&&(this.rate+=.5*(Math.min(this.sliceSize/s,8*this.rate)-this.rate))}this.fit(),this.dirty&&this.start();let n=this.frame;if(!n)return;let t=this.rate*Ot;this.sliceStarted=performance.now(),this.sliceSize=0,this.drawSlice(n,n.moving?1/0:t);let i=n.next>=n.jobs.length;(i||this.worthShowing(n))&&(n.shownAt=performance.now(),this.present(n.matrices,i),this.drawnOnce&&(n.jobs.length||!this.loading)&&(this.drawnOnce(),this.drawnOnce=null)),this.sync=e.fenceSync(e.SYNC_GPU_COMMANDS_COMPLETE,0),e.flush(),i&&(this.frame=null,this.rest=n.moving?null:n,++this.frames,n.moving||this.finished?.(),!n.moving&&!this.dirty&&!this.loading&&this.waiting.splice(0).forEach(s=>s())),this.schedule()}worthShowing({jobs:e,next:n,begun:t,shownAt:i}){let s=performance.now(),{what:r}=e[n],a=c=>c.what===r,l=(s-t)*e.slice(n).filter(a).length/Math.max(e.slice(0,n).filter(a).length,1);return s-i>Math.max(ft,zt*(i-t))&&(!this.frames||l>ft)}fit(){let{gl:e,canvas:n}=this,t=window.devicePixelRatio||1,i=e.getParameter(e.MAX_TEXTURE_SIZE)-2,s=Math.min(i,Math.max(1,Math.round(n.clientWidth*t))),r=Math.min(i,Math.max(1,Math.round(n.clientHeight*t)));if(s===this.width&&r===this.height)return;n.width=this.width=s,n.height=this.height=r,this.ratio=t;for(let l of Object.values(this.textures))e.deleteTexture(l);for(let l of Object.values(this.buffers))e.deleteFramebuffer(l);let a=this.textures={texels:J(e,e.RGBA32UI,s,r),depths:J(e,e.DEPTH_COMPONENT32F,s,r),drawn:J(e,e.RGBA8,s,r),shown:J(e,e.RGBA32UI,s+2,r+2),tiles:J(e,e.R8UI,Math.ceil(s/ue),Math.ceil(r/ue)),far:J(e,e.R32UI,Math.ceil(s/xe),Math.ceil(r/xe))};this.buffers={texels:j(e,a.texels,a.depths),scene:j(e,a.drawn,a.depths),drawn:j(e,a.drawn,null),shown:j(e,a.shown,null),tiles:j(e,a.tiles,null),far:j(e,a.far,null)},this.dirty=!0}start(){let{gl:e,camera:n,scene:t}=this,i=this.moving;this.dirty=!1;let s=n.view(),r=n.projection(this.width/this.height,t.bounds),a={view:s,projection:r,parallel:n.state.parallel,lights:u=>this.setLights(u,s),planes:this.planes},l=this.frame={jobs:[],next:0,share:1,drawn:0,begun:performance.now(),shownAt:performance.now(),matrices:a,moving:i};this.rest=null;for(let u of this.lines)u.layer.visible&&this.addJobs(l,u,u.set.blocks);let c=u=>l.jobs.reduce((f,d)=>f+d.lines.set.segments(u(d)),0);if(c(({block:u})=>u.items)>this.few){let u=({lines:d,block:{bounds:p}})=>F(E(s,d.model),[p[0]+p[1],p[2]+p[3],p[4]+p[5]].map(g=>g/2))[2],f=new Map(l.jobs.map(d=>[d,u(d)]));l.jobs.sort((d,p)=>f.get(p)-f.get(d)),l.jobs=l.jobs.map(d=>({...d,what:"likely"})),i?l.share=Math.min(1,this.rate*ut/c(({lines:d,block:p})=>(d.set.likely(p),p.likelies))):l.jobs.push(...l.jobs.map(d=>({...d,what:"others"})))}else i&&(l.share=Math.min(1,this.rate*ut/Math.max(c(({block:u})=>u.items),1)));this.frames||(l.shownAt=0),e.viewport(0,0,this.width,this.height),e.disable(e.BLEND),e.disable(e.CULL_FACE),e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.texels),e.clearBufferuiv(e.COLOR,0,[Ae,Ae,0,0]),e.depthMask(!0),e.clearBufferfv(e.DEPTH,0,[1]),this.drawBackdrop(a)}drawBackdrop(e){let{gl:n,scene:t}=this;n.bindFramebuffer(n.FRAMEBUFFER,this.buffers.scene),n.disable(n.DEPTH_TEST),n.bindVertexArray(null),this.program("page/screen.vert","page/background.frag").use().set({bottom:t.background[0],top:t.background[1],height:this.height}),n.drawArrays(n.TRIANGLES,0,3),n.enable(n.DEPTH_TEST),n.depthFunc(n.LEQUAL),n.depthMask(!0);let i=this.program("page/surface.vert","page/surface.frag");for(let r of this.surfaces)r.layer.visible&&!r.translucent&&r.draw(i,e);let s=this.program("page/image.vert","page/image.frag");for(let r of this.images)r.layer.visible&&r.layer.opacity>=1&&r.draw(s,e)}outside(e,n){let t=[0,0,0,0,0,0];for(let i=0;i<8;++i){let[s,r,a,l]=F(e,[n[i&1],n[2+(i>>1&1)],n[4+(i>>2)]]);[s<-l,s>l,r<-l,r>l,a<-l,a>l].forEach((c,u)=>t[u]+=c?1:0)}return t.some(i=>i===8)}setLights(e,n){let t=[0,0,0],i=0;this.scene.lights.slice(0,8).forEach((s,r)=>{let a=[0,0,1,0];s.view?a=[...s.view,0]:s.world&&(i=1,a=F(n,s.world,s.positional?1:0),a[3]=s.positional?1:0),e.set({[`light_colour[${r}]`]:s.colour,[`light_place[${r}]`]:a}),s.colour.forEach((l,c)=>t[c]+=l)}),e.ints({light_count:Math.min(this.scene.lights.length,8)}).set({light_sum:t,light_standing:i})}aim(e,n){let t=e.layer.line_width*this.ratio,i=t>1,s=E(n.view,E(e.model,e.set.toData)),r=E(n.projection,s),a=r.reduce((u,f)=>Math.max(u,Math.abs(f)),0)||1,l=new Float64Array(16);for(let u=0;u<4;++u){let[f,d,p,g]=[0,1,2,3].map(v=>r[v+4*u]/a);l.set([this.width/2*(f+g),this.height/2*(d+g),(p+g)/2,g],4*u)}this.frameBlock.write({window_from_local:l,reference:e.set.reference,half_line_width:i?t/2:0,viewport:[this.width,this.height]},["reference"]),this.frameBlock.bind();let c=[...e.layer.planes??[],...this.planes].slice(0,8);if(c.length){let u=E(e.model,e.set.toData),f=ge(r),d=new Float64Array(32),p=new Float64Array(32);c.forEach((g,v)=>{let m=[0,1,2,3].map(y=>g[0]*u[4*y]+g[1]*u[4*y+1]+g[2]*u[4*y+2]+g[3]*u[4*y+3]),b=Math.hypot(m[0],m[1],m[2])||1;if(m.forEach((y,T)=>d[4*v+T]=y/b),f)for(let y=0;y<2;++y){let T=[0,1,2,3].reduce((k,x)=>k+d[4*v+x]*f[x+4*y],0);p[4*v+y]=T*a*(2/(y===0?this.width:this.height))}}),this.clipBlock.write({clip_planes:d,clip_tilts:p,clip_plane_count:0,clip_rounding:0}),this.clipBlock.write({clip_plane_count:c.length},["clip_plane_count"]),this.clipBlock.bind()}return{wide:i,clipped:c.length>0,window:l}}pixelsOf(e,n,t){let i=E(n.projection,E(n.view,e.model)),s=e.set.bounds,r=Math.hypot(...ve(e.model)),a=1/0;for(let l=0;l<8;++l)a=Math.min(a,F(i,[s[l&1],s[2+(l>>1&1)],s[4+(l>>2)]])[3]);return a>0?t*r*(this.height/2)*n.projection[5]/a:1/0}drawSlice(e,n){let{gl:t}=this,i=null,s=null,r=!1,a=Re(),l=1,c=e.jobs[e.next]?.what==="others",u=this.findFarTiles(e.next>0,c);for(;e.next<e.jobs.length&&this.sliceSize<n;){let{lines:f,block:d,what:p}=e.jobs[e.next];if(p==="others"!==c&&this.sliceSize)break;if(++e.next,f.set.pointsOf(d),i!==f){i=f;let v=this.aim(f,e.matrices),{wide:m,clipped:b}=v;a=v.window,l=1+(m?f.layer.line_width*this.ratio/2:0);let y=["CLIPPING","CLIPPING_DEPTH","EDGES"];m&&y.push("WIDE_LINES"),b&&y.push("CLIP_PLANES"),r=!m&&this.pixelsOf(f,e.matrices,f.set.longestStep)<=Nt,r&&y.push("SPRITES"),f.values&&y.push("VALUES_STORED"),f.byPoint&&y.push("VALUES_COLOUR"),f.kept&&y.push("STREAMLINE_MASK"),f.keptPoints&&y.push("POINT_MASK"),s=this.program("page/segment.vert","page/segment.frag",y).use(),f.values&&s.set({value_code:f.values.code,shown_values:f.shownValues}),s.uints({layer:f.index*2**28})}let g=p==="others"&&u?f.set.look(d,a,l,this.width,this.height,u):f.set.likely(d);t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.texels),t.enable(t.DEPTH_TEST),t.depthFunc(t.LESS),this.frameBlock.bind(),s.use().textures({far_tiles:this.textures.far,items:f.set.items,kept:f.kept,kept_points:f.keptPoints,value_texels:f.values&&f.values.texture,point_colours:f.byPoint?f.colours:null}),p==="all"?this.sliceSize+=f.set.draw(d,s,e.share*d.items,r):this.sliceSize+=d.items+f.set.drawSome(d,s,g,r,Math.ceil(e.share*(p==="likely"?d.likelies:d.items)))}}present(e,n){let{gl:t,textures:i,buffers:s}=this;this.repaint(e),t.disable(t.DEPTH_TEST),t.bindVertexArray(null),this.findTiles(),t.bindFramebuffer(t.FRAMEBUFFER,s.drawn);let r=this.program("page/tiles.vert","page/resolve.frag").use(),a=ge(e.projection)??Re(),l=0;for(let c of this.lines){if(!c.layer.visible)continue;let{layer:u}=c,{colours:f}=u,d=u.line_width*this.ratio;l=Math.max(l,1-Math.min(1,d)),r.textures({texels:i.texels,depths:i.depths,colours:c.byPoint?null:c.colours,table:c.table,chosen:c.chosen??i.texels}),r.uints({layer:c.index*2**28,marked:c.marked}),r.ints({mode:Yt[f.mode],logarithm:f.log?1:0,light:Vt[u.light]}),r.set({one_colour:f.colour??[1,1,1],table_range:c.tableRange,reflects:u.reflects,sheen:u.sheen,chosen_colour:u.chosen?.colour??[0,0,0,0],faded:u.chosen?.faded??[0,0,0,0],data_to_view:ve(E(e.view,c.model)),pixel_to_view:new Float32Array(a),picture:[this.width,this.height]}),this.setLights(r,e.view),this.drawTiles(r)}if(this.drawTranslucent(e),t.disable(t.DEPTH_TEST),t.bindVertexArray(null),n&&this.scene.antialias&&this.lines.length){t.bindFramebuffer(t.FRAMEBUFFER,s.shown),t.viewport(0,0,this.width+2,this.height+2),this.program("page/screen.vert","page/visible_edges.frag").use().textures({texels:i.texels,depths:i.depths,drawn:i.drawn}).set({narrower:l}),t.drawArrays(t.TRIANGLES,0,3),t.viewport(0,0,this.width,this.height),t.bindFramebuffer(t.FRAMEBUFFER,s.drawn);let c=this.program("page/tiles.vert","effects/picture/antialias_coverage.frag").use().textures({shown:i.shown});t.uniform2i(c.at("shift"),1,1),this.drawTiles(c)}t.bindFramebuffer(t.FRAMEBUFFER,null),this.program("page/screen.vert","page/copy.frag").use().textures({drawn:i.drawn}),t.drawArrays(t.TRIANGLES,0,3),this.presented?.()}findTiles(){let{gl:e,textures:n}=this;e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.tiles),e.viewport(0,0,Math.ceil(this.width/ue),Math.ceil(this.height/ue)),this.program("page/screen.vert","page/tile_mask.frag").use().textures({texels:n.texels}),e.drawArrays(e.TRIANGLES,0,3),e.viewport(0,0,this.width,this.height)}drawTiles(e){let{gl:n}=this;e.textures({tiles:this.textures.tiles}).set({whole:[this.width,this.height]}),n.drawArraysInstanced(n.TRIANGLE_STRIP,0,4,Math.ceil(this.width/ue)*Math.ceil(this.height/ue))}repaint(e){this.frame&&this.frame.drawn++>0&&this.drawBackdrop(e)}drawTranslucent(e){let{gl:n}=this,t=this.surfaces.filter(a=>a.layer.visible&&a.translucent),i=this.images.filter(a=>a.layer.visible&&a.layer.opacity<1);if(!t.length&&!i.length)return;n.bindFramebuffer(n.FRAMEBUFFER,this.buffers.scene),n.enable(n.DEPTH_TEST),n.depthFunc(n.LEQUAL),n.depthMask(!1),n.enable(n.BLEND),n.blendFunc(n.SRC_ALPHA,n.ONE_MINUS_SRC_ALPHA);let s=this.program("page/surface.vert","page/surface.frag");t.sort((a,l)=>l.depth(e.view)-a.depth(e.view)).forEach(a=>a.draw(s,e));let r=this.program("page/image.vert","page/image.frag");i.forEach(a=>a.draw(r,e)),n.disable(n.BLEND),n.depthMask(!0)}pick(e,n){let{gl:t}=this,i=Math.floor(e*this.ratio),s=this.height-1-Math.floor(n*this.ratio),r=new Uint32Array(4),a=[[0,0],[1,0],[-1,0],[0,1],[0,-1],[2,0],[-2,0],[0,2],[0,-2]];for(let[l,c]of a){if(i+l<0||s+c<0||i+l>=this.width||s+c>=this.height||(t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.texels),t.readPixels(i+l,s+c,1,1,t.RGBA_INTEGER,t.UNSIGNED_INT,r),r[0]===Ae&&r[1]===Ae))continue;let u=this.lines[r[0]>>>28];if(!u)continue;let f=u.values?new Float32Array(new Uint32Array([r[3]]).buffer)[0]:null;return{lines:u,streamline:r[0]&268435455,value:f}}return null}placeOf(e,n,t,i){let{camera:s,scene:r,canvas:a}=this,l=a.clientWidth,c=a.clientHeight,u=E(s.projection(this.width/this.height,r.bounds),E(s.view(),e.model)),f=[0,0,0],d=1/0;for(let p of e.set.pointsOfStreamline(n)){let[g,v,,m]=F(u,p),b=Math.hypot((g/m+1)*l/2-t,(1-v/m)*c/2-i);m>0&&b<d&&([f,d]=[p,b])}return f}pixels(){let{gl:e,width:n,height:t}=this,i=new Uint8Array(4*n*t),s=new Uint8Array(i.length);e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.drawn),e.readPixels(0,0,n,t,e.RGBA,e.UNSIGNED_BYTE,i);for(let r=0;r<t;++r)s.set(i.subarray(4*n*r,4*n*(r+1)),4*n*(t-1-r));return s}};var ht=o=>document.getElementById(o)?.textContent??"",fe=4;async function Qt(o){let e=new Set(o.layers.map(n=>n.kind==="fiblets"?n.data:-1));return Promise.all(o.data.map(async(n,t)=>{if(n.file===void 0)return D(ht(`data-${t}`).trim());if(e.has(t))return new Uint8Array;let i=new ye(n.file,n.bytes);return await i.need(0,n.bytes),i.bytes}))}async function qt(o,e,n){let t=new Map;return await Promise.all(o.layers.map(async i=>{if(i.kind!=="fiblets")return;let{file:s,bytes:r}=o.data[i.data];if(s===void 0){t.set(i.data,Oe(e[i.data]));return}let a=new ye(s,r),l=i.colours.values===void 0?[]:[i.colours.values],c=await We(a,l);t.set(i.data,c),n.push({archive:c,remote:a,values:l})})),t}async function Ht(o,e){let n=document.createElement("progress"),t=1<<ie;n.setAttribute("aria-label","Streamlines that have come"),n.max=o.reduce((i,{archive:s})=>i+s.header.n_fiblets,0),document.getElementById("over").append(n),await Promise.all(o.map(async({archive:i,remote:s,values:r})=>{let a=i.header.n_fiblets,l=Math.ceil(a/t),c=f=>Je(s,i,f,Math.min(f+fe,l),t,r),u=c(0);for(let f=0;f<l;f+=fe){let d=u;f+fe<l&&(u=c(f+fe)).catch(()=>{}),await d,n.value+=Math.min((f+fe)*t,a)-i.ready,i.ready=Math.min((f+fe)*t,a),e.grow()}})),n.remove()}function dt(o){let e=document.getElementById("message");e.textContent=o instanceof Error?o.message:String(o),e.hidden=!1,document.body.dataset.state="failed"}async function Xt(){let o=JSON.parse(ht("scene"));document.title=o.title;let e=await Qt(o),n=[],t=await qt(o,e,n),i=new _e(document.getElementById("view"),o,e,t);i.loading=n.length>0,i.failed=dt,i.drawnOnce=()=>{document.body.dataset.state="drawn"},new ResizeObserver(()=>i.change()).observe(i.canvas);let s=new De(i,e);if(Ye(i,(r,a)=>s.pick(r,a)),ct(i,s),window.pvfiblets=i,!!n.length)try{await Ht(n,i)}finally{i.loading=!1,i.grow()}}window.pvfibletsPage={Renderer:_e,attachMouse:Ye,readArchive:Oe};document.getElementById("scene")&&Xt().catch(dt);})();
