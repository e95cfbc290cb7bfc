// Built by `make client` of sources cbf59d6ddb59af5a
"use strict";(()=>{var et=Object.defineProperty;var tt=(a,e,t)=>e in a?et(a,e,{enumerable:!0,configurable:!0,writable:!0,value:t}):a[e]=t;var f=(a,e,t)=>tt(a,typeof e!="symbol"?e+"":e,t);var x=class extends Error{},nt=101010256,rt=101075792,it=117853008,st=33639248,Ue=67324752,Pe="header.json",W="Copy or make the file again.",at=4096;function U(a,e){return a.getUint32(e,!0)+a.getUint32(e+4,!0)*4294967296}function ot(a){let e=a.byteLength;for(let t=e-22;t>=Math.max(0,e-65558);--t)if(a.getUint32(t,!0)===nt){if(t>=20&&a.getUint32(t-20,!0)===it){let n=U(a,t-12);if(n+56<=e&&a.getUint32(n,!0)===rt)return[U(a,n+48),U(a,n+32)]}return[a.getUint32(t+16,!0),a.getUint16(t+10,!0)]}throw new x("This is no whole .fiblets file: the end of its zip archive is missing. Copy or make it again.")}function lt(a,e,t,n){let r=a.getUint32(e+24,!0),i=a.getUint32(e+42,!0),s=a.getUint32(e+20,!0);for(let o=e+46+t,l=o+n;o+4<=l;){let c=a.getUint16(o,!0),u=a.getUint16(o+2,!0),d=o+4;c===1&&(r===4294967295&&(r=U(a,d),d+=8),s===4294967295&&(s=U(a,d),d+=8),i===4294967295&&(i=U(a,d))),o+=4+u}return[r,i]}var ct={"|u1":[1,Uint8Array],"|i1":[1,Int8Array],"|b1":[1,Uint8Array],"<u2":[2,Uint16Array],"<i2":[2,Int16Array],"<u4":[4,Uint32Array],"<i4":[4,Int32Array],"<f4":[4,Float32Array],"<f8":[8,Float64Array],"<i8":[8,BigInt64Array],"<u8":[8,BigUint64Array]};function Ae(a,e){let t=new x(`The member ${e} of the file is damaged. ${W}`);if(a.length<10||a[0]!==147||a[6]!==1)throw t;let n=a[8]|a[9]<<8,r=new TextDecoder("latin1").decode(a.subarray(10,10+n)),i=/'descr':\s*'([^']+)'/.exec(r),s=/'shape':\s*\(([^)]*)\)/.exec(r);if(!i||!s||/'fortran_order':\s*True/.test(r))throw t;let o=ct[i[1]];if(!o)return null;let l=s[1].split(",").map(p=>p.trim()).filter(p=>p).map(Number),c=l.reduce((p,g)=>p*g,1),u=a.byteOffset+10+n;if(!l.every(p=>Number.isSafeInteger(p)&&p>=0)||10+n+c*o[0]>a.length)throw t;let d=a.buffer,h=u%o[0]===0?new o[1](d,u,c):new o[1](d.slice(u,u+c*o[0]),0,c);return{shape:l,data:h}}function xe(a){let e=new DataView(a.buffer,a.byteOffset,a.byteLength);if(a.length<22)throw new x("This is no .fiblets file: it is empty, or cut short.");let[t,n]=ot(e),r=new Map,i=null,s=t;for(let o=0;o<n;++o){if(s+46>a.length||e.getUint32(s,!0)!==st)throw new x(`The list of the file's members is damaged. ${W}`);let l=e.getUint16(s+28,!0),c=e.getUint16(s+30,!0),u=e.getUint16(s+32,!0),d=new TextDecoder().decode(a.subarray(s+46,s+46+l)),[h,p]=lt(e,s,l,c);if(e.getUint16(s+10,!0)!==0)throw new x(`The member ${d} of the file is compressed; .fiblets files store their members as they are.`);if(p+30>a.length||e.getUint32(p,!0)!==Ue)throw new x(`The member ${d} of the file is damaged. ${W}`);let g=p+30+e.getUint16(p+26,!0)+e.getUint16(p+28,!0);if(g+h>a.length)throw new x(`The file ends within its member ${d}. Copy or make it again.`);let w=a.subarray(g,g+h);if(d===Pe)i=Me(w);else{let m=Ae(w,d);m&&r.set(d,m)}s+=46+l+c+u}return Oe(i,r,1/0)}function Me(a){try{return JSON.parse(new TextDecoder().decode(a))}catch{throw new x(`The file's header is damaged. ${W}`)}}function Oe(a,e,t){if(a===null||typeof a!="object")throw new x("This is a zip archive, but no .fiblets file: it has no header.json.");return{header:a,arrays:e,ready:t}}async function ze(a,e){let{bytes:t}=a,n=new DataView(t.buffer,t.byteOffset,t.byteLength),r=new Map,i=null;for(let s=0;s+30<=t.length&&(await a.need(s,Math.min(s+at,t.length)),n.getUint32(s,!0)===Ue);){let o=n.getUint16(s+26,!0),l=n.getUint16(s+28,!0),c=s+30+o+l,u=new TextDecoder().decode(t.subarray(s+30,s+30+o)),d=n.getUint32(s+18,!0);for(let h=s+30+o;d===4294967295&&h+20<=c;h+=4+n.getUint16(h+2,!0))n.getUint16(h,!0)===1&&(d=U(n,h+4));if(n.getUint16(s+8,!0)!==0||c+d>t.length)throw new x(`The member ${u} of the file is damaged. ${W}`);if(u===Pe)await a.need(c,c+d),i=Me(t.subarray(c,c+d));else{let h=Ae(t.subarray(c,c+d),u);h&&r.set(u,h),h&&(h.data.buffer!==t.buffer||u==="pages.npy")&&(await a.need(c,c+d),r.set(u,Ae(t.subarray(c,c+d),u)))}if(r.has("codes.npy")&&e.every(h=>r.has(i?.per_point?.[h]?.member)))break;s=c+d}return Oe(i,r,0)}var ut=[["anchors.npy",2,-1],["decoding.npy",3,-1],["anchors_low.npy",3,-1],["rank_to_id.npy",1,0],["codes.npy",1,1]];async function Ne(a,e,t,n,r,i){let s=e.arrays.get("pages.npy").data,o=e.header.n_fiblets,l=[...ut,...i.map(c=>[e.header.per_point?.[c]?.member,1,2])];await Promise.all(l.map(([c,u,d])=>{let h=e.arrays.get(c)?.data;if(!h)return;let[p,g]=[t,n].map(w=>(d<0?Math.min(w*r,o)*u:Number(s[3*w+d]))*h.BYTES_PER_ELEMENT);return a.need(h.byteOffset+p,Math.min(h.byteOffset+g+(d===1?4:0),a.bytes.length))}))}var L={blocks:{ClipPlanes:{bytes:400,fields:{clip_brushes:256,clip_plane_count:384,clip_planes:0,clip_rounding:388,clip_tilts:128}},Coding:{bytes:96,fields:{anchor_scale:0,end_vector_scale:28,lattice_edge:24,radius_scale:12,rotation_scales:32,step_low:16,step_span:20}},Frame:{bytes:208,fields:{half_line_width:172,line_reach:184,most_pixels_per_mm:192,plane_rounding:188,reference:160,segment_deviation:200,segment_size:204,view_planes:64,viewport:176,w_per_mm:196,window_from_local:0}},Rotations:{bytes:16384,fields:{rotations:0}}},fields:{anchor_x:[0,0,16],anchor_y:[0,16,16],anchor_z:[1,0,16],begin:[1,30,1],cap:[2,26,4],code:[1,0,22],end:[1,31,1],kind:[2,30,2],last:[2,20,6],point:[2,0,20],rank:[1,16,14],shape:[0,0,32],step:[1,22,10]},lines:`#version 300 es
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
#ifndef VARYING
#define VARYING flat out
VARYING uvec4 seg_ids;
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
uniform highp sampler2D point_colours;
vec4 colour_of(uint point){return texelFetch(point_colours,ivec2(int(point&4095u),int(point>>12u)),0);}
#if FEATURE_VALUES_STORED
uniform highp usampler2D value_texels;
uniform vec3 value_code;
float value_of(uint point){
uint code=texelFetch(value_texels,ivec2(int(point&4095u),int(point>>12u)),0).x;
return float(code)==value_code.z?uintBitsToFloat(0x7FC00000u):value_code.x+value_code.y*float(code);
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
vec2 values=vec2(0.0);
values=vec2(value_of(item.y+k),value_of(item.y+min(k+1u,points-(ends?1u:0u))));
vec3 from=uintBitsToFloat(slot_from.xyz),to=uintBitsToFloat(slot_to.xyz);
ClippedSegment piece;
if(!piece_of(from,to,start,cap,piece))return;
seg_ids=uvec4(item.x|layer,slot_from.w,slot_to.w,(piece.start?1u:0u)|(piece.cap?2u:0u));
seg_start=piece.a;
seg_end=piece.b;
seg_along=vec4(piece.t0,piece.t1,values);
seg_colours=uvec2(packUnorm4x8(colour_of(item.y+k)),packUnorm4x8(colour_of(item.y+min(k+1u,points-(ends?1u:0u)))));
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
vec2 size=abs(run)+1.0;
gl_PointSize=max(size.x,size.y);
gl_Position=vec4((p+q-2.0*CELL_SHIFT)/viewport-1.0,0.0,1.0);
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
vec3 unpacked_tangent(uint word){
ivec2 s=ivec2(int(word<<16)>>16,int(word)>>16);
vec2 p=vec2(s)/FIBLET_DIRECTION_SCALE;
float x=1.0-abs(p.x)-abs(p.y);
if(x<0.0)p=(1.0-abs(p.yx))*vec2(s.x<0?-1.0:1.0,s.y<0?-1.0:1.0);
return normalize(vec3(x,p));
Tangents unpacked_tangents(uvec2 words){return Tangents(unpacked_tangent(words.x),unpacked_tangent(words.y));}
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
Tangents ends=unpacked_tangents(seg_ids.yz);
uint bits=0u;
float value=value_between(t);
if(shown_values.x<=shown_values.y&&!(value>=shown_values.x&&value<=shown_values.y))discard;
bits=floatBitsToUint(value);
bits=packUnorm4x8(mix(unpackUnorm4x8(seg_colours.x),unpackUnorm4x8(seg_colours.y),t));
out_texel=uvec4(seg_ids.x,packed_tangent(tangent_between(ends,t),0u),edges,bits);
bool brush_kept(float s,vec2 away){
vec2 heights=vec2(clip_height_of(plane,seg_from),clip_height_of(plane,seg_to));
vec2 h=max(heights/max(vec2(seg_start.w,seg_end.w),vec2(1e-30)),vec2(0.0));
if(h.x+s*(h.y-h.x)+dot(clip_tilts[plane],away)<0.0)return false;
vec2 run=seg_end.xy-seg_start.xy,centre=gl_FragCoord.xy-seg_start.xy;
float foot=dot(centre,run)/max(dot(run,run),1e-12),s=clamp(foot,0.0,1.0);
vec2 away=centre-s*run;
if(foot<0.0&&(seg_ids.w&1u)==0u||dot(away,away)>half_line_width*half_line_width)discard;
if(foot>1.0&&beyond_joint(seg_onward,centre-run))discard;
if(!brush_kept(s,away))discard;
gl_FragDepth=clamp(seg_start.z+(seg_end.z-seg_start.z)*s,0.0,0.99999988);
write(s,capsule_edges(centre,run,half_line_width));
vec2 first=pixel_of(seg_start),run=pixel_of(seg_end)-first,at=floor(gl_FragCoord.xy)-first;
Cells cells=cells_between(ivec2(first),ivec2(first+run));
bool start=(seg_ids.w&1u)!=0u,cap=(seg_ids.w&2u)!=0u,steep=abs(run.y)>abs(run.x);
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
uniform highp usampler2D texels;
uniform highp sampler2D depths;
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
colour.a*=opacity;`,page_bits:14,rotation_scales:[39380907423947065e-23,5413425014921813e-22,7445069627465273e-22,1023472805172787e-21,14070004681343562e-22,19338988295203308e-22,2657444838405354e-21,3649580548881204e-21,5006992068956606e-21,6855771061964333e-21,9352394044981338e-21,1266809158551041e-20,1692779733275529e-20,22030990294297226e-21,27206533559365198e-21,300810752378311e-19],rotations:"AAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbRuK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6nLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420biuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07Svlg==",shaders:{"effects/picture/antialias_coverage.frag":[0,5,445,448,624,630,46,47,630,636,10,11,636,638,257,258,638,645,625,626,645,647,46,47,647,649,10,11,649,654,10,11,654,656,10,11,656,661,10,11,661,675,226,227,675,696,10,11],"page/background.frag":[0,5,697,700,587,588,700,701],"page/copy.frag":[0,5,610,611,587,588,696,697],"page/decode.vert":[0,13,10,11,13,55,46,47,55,57,46,47,57,76,72,73,76,77,75,76,77,81,72,73,81,85,75,76,85,87,10,11,87,93,10,11,93,99,10,11,99,105,10,11,105,118,10,11,118,121,10,11,121,125,10,11,125,138,10,11,138,141,10,11,75,76,10,11,141,142,131,132,142,143,75,76,143,146,10,11,75,76,146,157,46,47,157,174,125,126,174,178,10,11,75,76,10,11,178,179,125,126,174,175,179,184,137,138,10,11,75,76,184,186,10,11,186,188,10,11,188,192,10,11,192,193,163,164,193,194,125,126,194,196,154,156,196,198,10,11,75,76,198,199,10,11,199,203,10,11,203,209,10,11,209,212,10,11,212,215,10,11,215,219,10,11,219,243,10,11,243,254,10,11,254,257,10,11],"page/image.frag":[0,5,750,752,734,735,587,588,226,227,752,755,10,11],"page/image.vert":[0,5,705,706,744,748,226,227,748,750,10,11],"page/none.frag":[0,5,257,259],"page/resolve.frag":[0,5,430,431,14,15,475,481,10,11,528,539,10,11,539,551,10,11,10,11,551,560,10,11,560,561,10,11,561,567,553,554,567,571,10,11,571,572,10,11,572,575,380,381,575,588,226,227,588,603,10,11,603,608,10,11,608,610,10,11],"page/screen.vert":[0,5,527,528],"page/segment.frag":[0,5,259,260,261,267,10,11,430,431,34,47,293,296,10,11,296,297,431,438,46,47,438,445,10,11,297,304,46,47,304,307,10,11,75,76,445,454,10,11,369,370,454,459,10,11,75,76,459,470,10,11,75,76,355,356,470,471,14,15,203,209,10,11,209,212,10,11,471,475,10,11,475,481,10,11,481,483,361,363,75,76,363,369,75,76,369,371,297,298,371,373,75,76,75,76,373,374,483,484,385,386,484,490,10,11,75,76,490,495,385,386,495,498,75,76,367,368,498,499,75,76,499,500,10,11,369,370,297,298,500,501,312,313,501,504,10,11,349,350,10,11,75,76,226,227,504,509,297,298,509,510,75,76,510,512,10,11,83,84,226,227,512,524,10,11,524,527,10,11,75,76],"page/segment.vert":[0,5,259,267,10,11,34,47,267,271,10,11,271,273,120,121,10,11,273,275,120,121,10,11,275,277,10,11,277,281,10,11,281,292,10,11,292,293,10,11,293,296,10,11,296,304,46,47,304,307,10,11,307,311,10,11,311,318,10,11,292,293,10,11,318,319,83,84,319,321,75,76,321,326,46,47,326,335,46,47,335,341,10,11,341,350,10,11,350,353,10,11,353,355,10,11,355,361,10,11,361,363,75,76,363,369,75,76,369,371,297,298,371,373,75,76,75,76,57,58,373,376,369,370,376,377,75,76,377,383,75,76,367,368,383,385,75,76,385,391,10,11,75,76,226,227,391,399,381,382,399,400,75,76,400,402,385,386,402,403,75,76,403,410,367,368,410,411,75,76,369,370,411,412,297,298,412,414,75,76,414,419,83,84,419,421,416,417,421,426,137,138,10,11,426,430,75,76,10,11],"page/surface.frag":[0,5,528,532,534,535,719,721,543,545,721,724,10,11,724,725,10,11,561,567,553,554,567,571,10,11,571,572,10,11,725,735,578,580,735,737,587,588,226,227,737,744,10,11],"page/surface.vert":[0,5,701,713,226,227,713,719,10,11],"page/visible_edges.frag":[0,5,264,267,10,11,445,446,447,448,572,574,610,618,10,11,226,227,618,624,10,11]}};var dt=L.lines.split(`
`);function ht(a){let e=[];for(let t=0;t<a.length;t+=2)e.push(...dt.slice(a[t],a[t+1]));return e.join(`
`)+`
`}var ue={};for(let[a,e]of Object.entries(L.shaders))ue[a]=ht(e);var J=L.blocks,Ge=L.rotation_scales,G=L.page_bits;function B(a){let e=atob(a),t=new Uint8Array(e.length);for(let n=0;n<e.length;++n)t[n]=e.charCodeAt(n);return t}var Ye=B(L.rotations),pt=L.fields;function F(a,e){let[,t,n]=pt[a];return n===32?e:e>>>t&(1<<n)-1}var j=(a,e)=>[a[0]-e[0],a[1]-e[1],a[2]-e[2]],D=(a,e,t=1)=>[a[0]+t*e[0],a[1]+t*e[1],a[2]+t*e[2]],M=(a,e)=>[a[0]*e,a[1]*e,a[2]*e],Z=(a,e)=>a[0]*e[0]+a[1]*e[1]+a[2]*e[2],Y=(a,e)=>[a[1]*e[2]-a[2]*e[1],a[2]*e[0]-a[0]*e[2],a[0]*e[1]-a[1]*e[0]],Qe=a=>Math.hypot(a[0],a[1],a[2]),P=a=>M(a,1/(Qe(a)||1));function _(a,e){let t=new Float64Array(16);for(let n=0;n<4;++n)for(let r=0;r<4;++r){let i=0;for(let s=0;s<4;++s)i+=a[r+4*s]*e[s+4*n];t[r+4*n]=i}return t}function _e(){let a=new Float64Array(16);return a[0]=a[5]=a[10]=a[15]=1,a}function $(a){let e=Array.from({length:4},(n,r)=>Array.from({length:8},(i,s)=>s<4?a[r+4*s]:s-4===r?1:0));for(let n=0;n<4;++n){let r=n;for(let s=n+1;s<4;++s)Math.abs(e[s][n])>Math.abs(e[r][n])&&(r=s);if(!(Math.abs(e[r][n])>0))return null;[e[n],e[r]]=[e[r],e[n]];let i=e[n][n];for(let s=0;s<8;++s)e[n][s]/=i;for(let s=0;s<4;++s){if(s===n)continue;let o=e[s][n];for(let l=0;l<8;++l)e[s][l]-=o*e[n][l]}}let t=new Float64Array(16);for(let n=0;n<4;++n)for(let r=0;r<4;++r)t[n+4*r]=e[n][r+4];return t}function S(a,e,t=1){return[0,1,2,3].map(n=>a[n]*e[0]+a[n+4]*e[1]+a[n+8]*e[2]+a[n+12]*t)}function ee(a){return[a[0],a[1],a[2],a[4],a[5],a[6],a[8],a[9],a[10]]}var de=a=>new Float32Array(a);function Ee(a,e,t){let n=t*Math.PI/180,r=Math.cos(n),i=Math.sin(n),s=P(e);return D(D(M(a,r),Y(s,a),i),s,Z(s,a)*(1-r))}var fe=class{constructor(e){f(this,"state",e)}get forward(){return P(j(this.state.focal_point,this.state.position))}get right(){return P(Y(this.forward,this.state.up))}get distance(){return Qe(j(this.state.focal_point,this.state.position))}view(){let e=this.forward,t=this.right,n=Y(t,e),r=this.state.position;return new Float64Array([t[0],n[0],-e[0],0,t[1],n[1],-e[1],0,t[2],n[2],-e[2],0,-Z(t,r),-Z(n,r),Z(e,r),1])}range(e){let t=this.forward,n=this.state.position,r=1/0,i=-1/0;for(let o=0;o<8;++o){let l=Z(t,j([e[o&1],e[2+(o>>1&1)],e[4+(o>>2)]],n));r=Math.min(r,l),i=Math.max(i,l)}let s=Math.max(.005*(i-r),1e-6*Math.abs(i));return r-=s,i+=s,this.state.parallel?[r,Math.max(i,r+1e-6)]:(i=Math.max(i,1e-6),[Math.max(r,.001*i),i])}projection(e,t){let[n,r]=this.range(t),i=new Float64Array(16),s=this.state;if(s.parallel)i[0]=1/(s.parallel_scale*e),i[5]=1/s.parallel_scale,i[10]=-2/(r-n),i[14]=-(r+n)/(r-n),i[15]=1;else{let o=1/Math.tan(s.view_angle*Math.PI/360);i[0]=o/e,i[5]=o,i[10]=-(r+n)/(r-n),i[11]=-1,i[14]=-2*r*n/(r-n)}return i}rotate(e,t){let n=this.state,r=Ee(j(n.position,n.focal_point),n.up,-200*e),i=P(Y(M(r,-1),n.up));r=Ee(r,i,-200*t),n.position=D(n.focal_point,r),n.up=P(Y(i,P(M(r,-1))))}roll(e){this.state.up=Ee(this.state.up,this.forward,e)}pan(e,t){let n=this.state,r=n.parallel?2*n.parallel_scale:2*this.distance*Math.tan(n.view_angle*Math.PI/360),i=Y(this.right,this.forward),s=D(M(this.right,-e*r),i,-t*r);n.position=D(n.position,s),n.focal_point=D(n.focal_point,s)}dolly(e){let t=this.state;t.parallel?t.parallel_scale/=e:t.position=D(t.focal_point,j(t.position,t.focal_point),1/e)}lookAlong(e,t,n){let r=this.state,i=[(n[0]+n[1])/2,(n[2]+n[3])/2,(n[4]+n[5])/2],s=Math.hypot(n[1]-n[0],n[3]-n[2],n[5]-n[4])/2||1,o=s/Math.sin(r.view_angle*Math.PI/360);r.focal_point=i,r.position=D(i,P(e),-o),r.up=t,r.parallel_scale=s}};function v(a,e={},...t){let n=document.createElement(a);for(let[r,i]of Object.entries(e))n.setAttribute(r,i);return n.append(...t),n}var k=a=>Number.isFinite(a)?String(Number(a.toPrecision(4))):"no value";function I(a,e,t,n,r){let i=(t-e)/200||1,s=v("output",{},k(n)),o=v("input",{type:"range",min:String(e),max:String(t),step:String(i),value:String(n)});return o.addEventListener("input",()=>{s.textContent=k(o.valueAsNumber),r(o.valueAsNumber)}),v("label",{},v("span",{},a),o,s)}function te(a,e){let t=v("button",{type:"button"},a);return t.addEventListener("click",e),t}function Q(a,...e){return v("fieldset",{},v("legend",{},a),...e)}var mt=[["Left",[1,0,0],[0,0,1]],["Right",[-1,0,0],[0,0,1]],["Front",[0,-1,0],[0,0,1]],["Back",[0,1,0],[0,0,1]],["Top",[0,0,-1],[0,1,0]],["Bottom",[0,0,1],[0,1,0]]];function gt(a){let e=B(a.table),t=e.length/4,n=v("canvas",{width:String(t),height:"1",role:"img","aria-label":`Colours from ${k(a.clim[0])} to ${k(a.clim[1])}`}),r=n.getContext("2d"),i=r.createImageData(t,1);i.data.set(e),r.putImageData(i,0,0);let[s,o]=a.clim,l=a.log?Math.sqrt(s*o):(s+o)/2;return v("figure",{class:"bar"},v("figcaption",{},a.title),n,v("div",{class:"ticks","aria-hidden":"true"},...[s,l,o].map(c=>v("span",{},k(c)))))}var Te=class{constructor(e,t){f(this,"lines",e);f(this,"base",t);f(this,"ranges",new Map);f(this,"regions",new Map)}set(e,t,n,r){let i=this.ranges.get(e.name)??{values:t,low:e.range[0],high:e.range[1],whole:e.range};n===0?i.low=r:i.high=r,this.ranges.set(e.name,i),this.apply()}apply(){let e=[...this.ranges.values()].filter(r=>r.low>r.whole[0]||r.high<r.whole[1]);if(!e.length&&!this.regions.size)return this.lines.keep(this.base);let t=this.lines.set.streamlines,n=new Uint8Array(t);for(let r=0;r<t;++r){let i=this.base===null||this.base[r]!==0;for(let s of e){let o=1e-6*(s.whole[1]-s.whole[0]);i=i&&s.values[r]>=s.low-o&&s.values[r]<=s.high+o}for(let s of this.regions.values())i=i&&s[r]!==0;n[r]=i?1:0}this.lines.keep(n)}},he=class{constructor(e,t){f(this,"renderer",e);f(this,"data",t);f(this,"told",null);f(this,"status",document.getElementById("status"));f(this,"axes",[]);f(this,"choices",new Map);f(this,"picked",null);f(this,"radius",5);let n=document.getElementById("over"),{scene:r}=e,i=v("details",{id:"panel"},v("summary",{},"Scene"));i.append(this.layers(),this.views(),this.cut(),...this.ranges(),this.region()),n.append(i),r.bars.length&&n.append(v("div",{id:"bars"},...r.bars.map(gt))),n.append(this.orientation()),e.restored=()=>{for(let s of this.choices.values())s.apply()},e.presented=()=>this.turnAxes(),this.turnAxes()}layers(){let{renderer:e}=this,t=[];return e.scene.layers.forEach(n=>{let r=v("input",{type:"checkbox"});r.checked=n.visible,r.addEventListener("change",()=>{n.visible=r.checked,e.change()}),t.push(v("label",{},r,v("span",{},n.name))),n.kind==="fiblets"?t.push(I("Line width",.5,10,n.line_width,i=>{n.line_width=i,e.change(!0)})):t.push(I("Opacity",0,1,n.opacity,i=>{n.opacity=i,e.change(!0)}))}),Q("Shown",...t)}views(){let{renderer:e}=this,t=structuredClone(e.camera.state),n=mt.map(([r,i,s])=>te(r,()=>{e.camera.lookAlong(i,s,e.scene.bounds),e.change()}));return n.push(te("As at first",()=>{Object.assign(e.camera.state,structuredClone(t)),e.change()})),n.push(te("Save picture",()=>this.save())),Q("View",v("div",{class:"buttons"},...n))}save(){let{renderer:e}=this;e.settled().then(()=>{let t=v("canvas",{width:String(e.width),height:String(e.height)}),n=t.getContext("2d"),r=n.createImageData(e.width,e.height);r.data.set(e.pixels()),n.putImageData(r,0,0),t.toBlob(i=>{let s=v("a",{href:URL.createObjectURL(i),download:"picture.png"});s.click(),setTimeout(()=>URL.revokeObjectURL(s.href),6e4)})})}cut(){let{renderer:e}=this,t=e.scene.bounds,n=v("select",{"aria-label":"Cut across"});for(let l of["nothing","left to right","back to front","bottom to top"])n.append(v("option",{},l));let r=v("div"),i=0,s=0,o=()=>{let l=n.selectedIndex-1,c=u=>[0,1,2].map(d=>d===l?u:0).concat(-u*i+s/2);e.planes=l<0?[]:[c(1),c(-1)],e.change(!0)};return n.addEventListener("change",()=>{let l=n.selectedIndex-1;if(r.replaceChildren(),l>=0){let c=t[2*l],u=t[2*l+1];i=(c+u)/2,s=(u-c)/8,r.append(I("Middle",c,u,i,d=>{i=d,o()}),I("Thickness",(u-c)/200,u-c,s,d=>{s=d,o()}))}o()}),Q("Slab across",n,r)}choiceOf(e){let t=this.choices.get(e.index);return t||this.choices.set(e.index,t=new Te(e,e.layer.kept===void 0?null:this.data[e.layer.kept])),t}ranges(){let{renderer:e}=this,t=[];for(let n of e.lines){let{values:r,layer:i}=n;if(r){let s=r.code[0],o=s+r.code[1]*(r.code[2]-1),l=[s,o],c=()=>{e.lines[n.index].shownValues=l[0]>s||l[1]<o?[l[0],l[1]]:[1,0],e.change(!0)};t.push(Q(r.name,I("From",s,o,s,u=>{l[0]=u,c()}),I("To",s,o,o,u=>{l[1]=u,c()})))}for(let s of i.controls??[]){if(s.data===void 0)continue;let o=this.data[s.data],l=new Float32Array(o.slice().buffer),[c,u]=s.range,d=h=>p=>{this.choiceOf(e.lines[n.index]).set(s,l,h,p),e.change(!0)};t.push(Q(s.name,I("From",c,u,c,d(0)),I("To",c,u,u,d(1))))}}return t}region(){let{renderer:e}=this,t=e.scene.bounds,n=Math.hypot(t[1]-t[0],t[3]-t[2],t[5]-t[4]);this.radius=n/40;let r=()=>{if(!this.picked){this.status.textContent="Click on a streamline first.";return}let{lines:s,place:o}=this.picked,l=s.set.through(o,this.radius),c=this.choiceOf(s);c.regions.set("ball",l),c.apply(),e.change(),this.status.textContent=`${l.reduce((u,d)=>u+d,0)} streamlines pass within ${k(this.radius)} mm of the place`},i=()=>{for(let s of this.choices.values())s.regions.clear(),s.apply();e.change(),this.status.textContent=""};return Q("Region",I("Radius, mm",n/1e3,n/5,this.radius,s=>{this.radius=s}),v("div",{class:"buttons"},te("Those through the picked place",r),te("All",i)))}pick(e,t){let{renderer:n}=this,r=n.pick(e,t);if(this.unmark(),r){let{lines:i,streamline:s,value:o}=r,l=n.placeOf(i,s,e,t),c=S(i.model,l).slice(0,3);this.say(i,s,o,c),this.picked={lines:i,streamline:s,place:l},this.told?.({layer:n.scene.layers.indexOf(i.layer),streamline:s,place:c})}else this.told?.(null);n.change()}mark(e){this.unmark();let t=e&&this.renderer.lines.find(({layer:n})=>n===this.renderer.scene.layers[e.layer]);if(e&&t&&e.streamline>=0&&e.streamline<t.set.streamlines){let{streamline:n}=e,r=t.set.pointsOfStreamline(n),i=r[r.length>>1];this.say(t,n,null,e.place??[]),i&&(this.picked={lines:t,streamline:n,place:i})}this.renderer.change()}unmark(){for(let e of this.renderer.lines)e.marked=4294967295;this.picked=null,this.status.textContent=""}say(e,t,n,r){e.marked=t;let i=[`Streamline ${t} of ${e.layer.name}`];n!==null&&e.values&&i.push(`${e.values.name} ${k(n)}`);for(let s of e.layer.controls??[])s.data!==void 0&&i.push(`${s.name} ${k(new Float32Array(this.data[s.data].slice().buffer)[t])}`);r.length&&i.push(`at ${r.map(k).join(", ")} mm`),this.status.textContent=i.join("; ")}orientation(){let t=(this.renderer.scene.letters?[["L","R"],["P","A"],["I","S"]]:[["","x"],["","y"],["","z"]]).flat().map((n,r)=>v("span",{class:`axis a${r>>1}`},n));return this.axes=t,v("div",{id:"axes","aria-hidden":"true"},...t)}turnAxes(){let e=this.renderer.camera.view();this.axes.forEach((t,n)=>{let r=M([0,1,2].map(l=>l===n>>1?1:0),n&1?1:-1),[i,s,o]=S(e,r,0);t.style.transform=`translate(${(i*32).toFixed(1)}px, ${(-s*32).toFixed(1)}px)`,t.style.opacity=String(.35+.65*(.5+o/2))})}};function Fe(a,e=()=>{}){let{canvas:t,camera:n}=a,r=new Map,i=0,s=0;t.addEventListener("pointerdown",l=>{t.focus(),t.setPointerCapture(l.pointerId),r.set(l.pointerId,{x:l.offsetX,y:l.offsetY}),i=0,s=l.button,l.preventDefault()}),t.addEventListener("contextmenu",l=>l.preventDefault());let o=l=>{r.delete(l.pointerId)&&(l.type==="pointerup"&&i<4&&s===0&&!r.size?e(l.offsetX,l.offsetY):a.change())};t.addEventListener("pointerup",o),t.addEventListener("pointercancel",o),t.addEventListener("pointermove",l=>{let c=r.get(l.pointerId);if(!c)return;let u=l.offsetX-c.x,d=l.offsetY-c.y,h=t.clientWidth,p=t.clientHeight;if(i+=Math.abs(u)+Math.abs(d),r.size===2){let g=[...r.entries()].find(([b])=>b!==l.pointerId)[1],w=[c.x-g.x,c.y-g.y],m=[l.offsetX-g.x,l.offsetY-g.y];n.dolly(Math.hypot(m[0],m[1])/Math.max(1,Math.hypot(w[0],w[1]))),n.roll((Math.atan2(m[1],m[0])-Math.atan2(w[1],w[0]))*180/Math.PI),n.pan(u/2/p,-d/2/p)}else s===1||l.shiftKey?n.pan(u/p,-d/p):s===2?n.dolly(Math.pow(1.1,-20*.2*d/(p/2)*5)):l.ctrlKey?n.roll(180*u/h):n.rotate(u/h,-d/p);c.x=l.offsetX,c.y=l.offsetY,a.change(!0)}),t.addEventListener("wheel",l=>{n.dolly(Math.pow(1.1,Math.max(-3,Math.min(3,-l.deltaY/50)))),a.change(!0),l.preventDefault()},{passive:!1}),t.addEventListener("keydown",l=>{let u={ArrowLeft:()=>l.shiftKey?n.pan(-.04,0):n.rotate(-.04,0),ArrowRight:()=>l.shiftKey?n.pan(.04,0):n.rotate(.04,0),ArrowUp:()=>l.shiftKey?n.pan(0,.04):n.rotate(0,.04),ArrowDown:()=>l.shiftKey?n.pan(0,-.04):n.rotate(0,-.04),"+":()=>n.dolly(1.1),"=":()=>n.dolly(1.1),"-":()=>n.dolly(.9090909090909091),Enter:()=>e(t.clientWidth/2,t.clientHeight/2)};l.altKey||l.metaKey||!u[l.key]||(u[l.key](),a.change(!0),l.preventDefault())})}var Be=a=>Array.isArray(a)&&a.length===3&&a.every(Number.isFinite);function Ve(a,e){let{parent:t}=window;if(t===window)return;let n=s=>t.postMessage({pvfiblets:s},"*"),{state:r}=a.camera,i=JSON.stringify(r);window.addEventListener("message",s=>{let o=s.source===t?s.data?.pvfiblets:void 0;if(!o)return;let{camera:l,picked:c}=o;if(l&&Be(l.position)&&Be(l.focal_point)&&Be(l.up)&&l.view_angle>0&&l.parallel_scale>0){Object.assign(r,l);let u=JSON.stringify(r);u!==i&&a.change(),i=u}c!==void 0&&e.mark(c)}),a.finished=()=>{let s=JSON.stringify(r);s!==i&&n({camera:JSON.parse(i=s)})},e.told=s=>n({picked:s}),n({ready:!0})}var ne=class{constructor(e,t){f(this,"file",e);f(this,"bytes");f(this,"come",0);f(this,"whole",null);f(this,"waiting",[]);f(this,"had",[]);this.bytes=new Uint8Array(t)}async need(e,t){t<=e||this.had.some(([n,r])=>n<=e&&r>=t)||(this.whole||await this.tried(e,t),this.whole&&await this.upTo(t))}async tried(e,t){for(let n=2;;--n)try{return await this.ask(e,t)}catch(r){if(!(r instanceof TypeError))throw r;if(!n)throw new Error(`${this.file} cannot be read: the connection to its server broke, or there is no server. Files beside a page need one; "python -m http.server" is enough.`);await new Promise(i=>setTimeout(i,500))}}async ask(e,t){let n=await fetch(this.file,{headers:{Range:`bytes=${e}-${t-1}`}});if(!n.ok)throw new Error(`${this.file} cannot be read (${n.status}); it must lie beside this page.`);if(n.status!==206){this.whole?n.body?.cancel():this.whole=this.flow(n);return}let r=Number(/\/(\d+)$/.exec(n.headers.get("Content-Range")??"")?.[1]??this.bytes.length),i=new Uint8Array(await n.arrayBuffer());if(r!==this.bytes.length||i.length!==t-e)throw this.changed(r);this.bytes.set(i,e),this.had.push([e,t])}async flow(e){let t=e.body.getReader();for(;;){let{done:n,value:r}=await t.read();if(n)break;if(this.come+r.length>this.bytes.length)throw this.changed(this.come+r.length);this.bytes.set(r,this.come),this.come+=r.length,this.waiting=this.waiting.filter(i=>i.end<=this.come?i.resolve():!0)}if(this.come!==this.bytes.length)throw this.changed(this.come)}async upTo(e){e>this.come&&await Promise.race([this.whole,new Promise(t=>this.waiting.push({end:e,resolve:t}))])}changed(e){return new Error(`${this.file} has ${e} bytes, and this page was made with one of ${this.bytes.length}. Copy the page and its folder again.`)}};var C=4096,V=class extends Error{};function bt(a,e){return(e.includes("SPRITES")?ue[a].replace("const bool SPRITES=false","const bool SPRITES=true"):ue[a]).replace(/#define FEATURE_(\w+) [01]/g,(n,r)=>`#define FEATURE_${r} ${e.includes(r)?1:0}`)}var q=class{constructor(e,t,n,r=[],i=[]){f(this,"gl",e);f(this,"handle");f(this,"places",new Map);f(this,"units",new Map);this.handle=e.createProgram();let s=[[e.VERTEX_SHADER,t],[e.FRAGMENT_SHADER,n]].map(([o,l])=>{let c=e.createShader(o);return e.shaderSource(c,bt(l,r)),e.compileShader(c),e.attachShader(this.handle,c),[l,c]});if(i.length&&e.transformFeedbackVaryings(this.handle,i,e.INTERLEAVED_ATTRIBS),e.linkProgram(this.handle),!e.getProgramParameter(this.handle,e.LINK_STATUS)&&!e.isContextLost()){let o=s.map(([l,c])=>`${l}: ${e.getShaderInfoLog(c)}`).join("; ");throw new V(`This browser's graphics cannot run the page's programs: ${e.getProgramInfoLog(this.handle)} ${o}`)}Object.keys(J).forEach((o,l)=>{let c=e.getUniformBlockIndex(this.handle,o);c!==e.INVALID_INDEX&&e.uniformBlockBinding(this.handle,c,l)})}use(){return this.gl.useProgram(this.handle),this}at(e){return this.places.has(e)||this.places.set(e,this.gl.getUniformLocation(this.handle,e)),this.places.get(e)}set(e){let t=this.gl;for(let[n,r]of Object.entries(e)){let i=this.at(n);i!==null&&(typeof r=="number"?t.uniform1f(i,r):r.length===2?t.uniform2fv(i,r):r.length===3?t.uniform3fv(i,r):r.length===4?t.uniform4fv(i,r):r.length===9?t.uniformMatrix3fv(i,!1,r):t.uniformMatrix4fv(i,!1,r))}return this}ints(e){for(let[t,n]of Object.entries(e)){let r=this.at(t);r!==null&&this.gl.uniform1i(r,n)}return this}uints(e){for(let[t,n]of Object.entries(e)){let r=this.at(t);r!==null&&this.gl.uniform1ui(r,n)}return this}textures(e){let t=this.gl;for(let[n,r]of Object.entries(e)){let i=this.at(n);if(i===null)continue;this.units.has(n)||this.units.set(n,this.units.size);let s=this.units.get(n);t.activeTexture(t.TEXTURE0+s),t.bindTexture(t.TEXTURE_2D,r),t.uniform1i(i,s)}return this}},Ie={r8ui:["R8UI","RED_INTEGER","UNSIGNED_BYTE",1,Uint8Array],r16ui:["R16UI","RED_INTEGER","UNSIGNED_SHORT",1,Uint16Array],r32ui:["R32UI","RED_INTEGER","UNSIGNED_INT",1,Uint32Array],rg32ui:["RG32UI","RG_INTEGER","UNSIGNED_INT",2,Uint32Array],rgba32ui:["RGBA32UI","RGBA_INTEGER","UNSIGNED_INT",4,Uint32Array],rgba8:["RGBA8","RGBA","UNSIGNED_BYTE",4,Uint8Array]};function qe(a){for(let e of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])a.texParameteri(a.TEXTURE_2D,a[e],a.NEAREST);for(let e of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])a.texParameteri(a.TEXTURE_2D,a[e],a.CLAMP_TO_EDGE)}function re(a,e,t,n){let[r]=Ie[e],i=Math.max(1,Math.ceil(t/C)),s=a.getParameter(a.MAX_TEXTURE_SIZE);if(i>s)throw new V(`The ${n} have ${t} texels; this device's textures hold ${s*C}. Make a page of fewer streamlines.`);let o=a.createTexture();return a.bindTexture(a.TEXTURE_2D,o),qe(a),a.texStorage2D(a.TEXTURE_2D,1,a[r],C,i),o}function X(a,e,t,n,r,i){let[,s,o,l,c]=Ie[t],u=C*l,d=Math.floor(n.length/u),h=Math.ceil(i/C);a.bindTexture(a.TEXTURE_2D,e),a.pixelStorei(a.UNPACK_ALIGNMENT,1);for(let p=Math.floor(r/C);p<Math.min(d,h);p+=256){let g=Math.min(256,d-p,h-p);a.texSubImage2D(a.TEXTURE_2D,0,0,p,C,g,a[s],a[o],n.subarray(p*u,(p+g)*u))}if(h>d){let p=new c(u);p.set(n.subarray(d*u)),a.texSubImage2D(a.TEXTURE_2D,0,0,d,C,1,a[s],a[o],p)}}function O(a,e,t,n){let r=Math.ceil(t.length/Ie[e][3]),i=re(a,e,r,n);return X(a,i,e,t,0,r),i}function pe(a,e,t,n){let r=e.length/4-3,[i,s]=n?t.map(o=>Math.log10(o)):t;return[O(a,"rgba8",e,"colours"),[i,s,r/Math.max(s-i,1e-30),r]]}function ie(a,e,t,n){let r=a.createTexture();return a.bindTexture(a.TEXTURE_2D,r),qe(a),a.texStorage2D(a.TEXTURE_2D,1,e,t,n),r}function se(a,e,t){let n=a.createFramebuffer();return a.bindFramebuffer(a.FRAMEBUFFER,n),a.framebufferTexture2D(a.FRAMEBUFFER,a.COLOR_ATTACHMENT0,a.TEXTURE_2D,e,0),t&&a.framebufferTexture2D(a.FRAMEBUFFER,a.DEPTH_ATTACHMENT,a.TEXTURE_2D,t,0),n}var R=class{constructor(e,t){f(this,"gl",e);f(this,"name",t);f(this,"bytes");f(this,"floats");f(this,"words");f(this,"buffer");f(this,"binding");this.bytes=new ArrayBuffer(J[t].bytes),this.floats=new Float32Array(this.bytes),this.words=new Uint32Array(this.bytes),this.buffer=e.createBuffer(),this.binding=Object.keys(J).indexOf(t),e.bindBuffer(e.UNIFORM_BUFFER,this.buffer),e.bufferData(e.UNIFORM_BUFFER,this.bytes.byteLength,e.DYNAMIC_DRAW)}write(e,t=[]){for(let[n,r]of Object.entries(e)){let i=J[this.name].fields[n]/4,s=t.includes(n)?this.words:this.floats;typeof r=="number"?s[i]=r:s.set(r,i)}this.upload()}fill(e){new Uint8Array(this.bytes).set(e),this.upload()}upload(){this.gl.bindBuffer(this.gl.UNIFORM_BUFFER,this.buffer),this.gl.bufferSubData(this.gl.UNIFORM_BUFFER,0,new Uint8Array(this.bytes))}bind(){this.gl.bindBufferBase(this.gl.UNIFORM_BUFFER,this.binding,this.buffer)}};var vt=1024,ae=16,wt=[4,8,11,15],Xe=0,yt=3;function He(a,e,t,n){if(!a||!(a.data instanceof Uint32Array)||a.data.length!==t*n)throw new x(`The file's ${e} do not fit its header. Copy or make it again.`);return a.data}function Ke(a){let e=Math.ceil(a.byteLength/4);if(a.byteOffset%4===0&&a.byteOffset+4*e<=a.buffer.byteLength)return new Uint32Array(a.buffer,a.byteOffset,e);let t=new Uint8Array(4*e);return t.set(new Uint8Array(a.buffer,a.byteOffset,a.byteLength)),new Uint32Array(t.buffer)}var me=class{constructor(e,t){f(this,"gl",e);f(this,"archive",t);f(this,"blocks",[]);f(this,"streamlines");f(this,"points");f(this,"bounds");f(this,"reference");f(this,"toData");f(this,"coding");f(this,"budget",256<<20);f(this,"parameters");f(this,"decodeProgram",null);f(this,"rotationBlock");f(this,"frameForDecoding");f(this,"textures",{});f(this,"itemBuffer");f(this,"toItems");f(this,"feedback");f(this,"scratch",null);f(this,"scratchBytes",0);f(this,"share",15);f(this,"itemBytes",15*ae);f(this,"kinds",new Set);f(this,"table");f(this,"done",0);f(this,"shares",0);f(this,"before",0);f(this,"open",null);f(this,"growing",{});f(this,"values",[]);f(this,"held",0);f(this,"clock",0);f(this,"fiblets");f(this,"decodeArray");f(this,"arrays",[null,null]);let{header:n,arrays:r}=t;if(n.format!=="fiblets")throw new x("The file is no .fiblets file: its header says something else.");if(n.version!==2)throw new x(`The file is of version ${n.version}; this page reads version 2. Make the page again with a newer pvfiblets.`);let i=this.parameters=n.parameters,s=this.fiblets=n.n_fiblets;this.streamlines=n.n_streamlines,this.points=n.n_points,this.bounds=n.bounds;let o=He(r.get("anchors.npy"),"anchors",2,s),l=He(r.get("decoding.npy"),"records",3,s),c=r.get("codes.npy"),u=r.get("pages.npy");if(!c||!(c.data instanceof Uint8Array)||!u||!(u.data instanceof BigInt64Array))throw new x("The file's codes or pages are missing. Copy or make it again.");let d=this.table=Array.from(u.data,Number),h=Math.ceil(s/(1<<G));if(d.length!==3*(h+1)||d[3*h+1]!==c.data.length||d[3*h+2]!==this.points)throw new x("The file's table of pages does not fit its records. Copy or make it again.");let p=i.anchor_bits===32?r.get("anchors_low.npy"):void 0;if(i.anchor_bits===32&&!(p?.data instanceof Uint16Array&&p.data.length===3*s))throw new x("The lower halves of the file's anchors are missing. Copy or make it again.");let g=i.anchor_bits===32?4294967295:65535;this.reference=[0,1,2].map(m=>{let b=(this.bounds[2*m]+this.bounds[2*m+1])/2,A=i.anchor_scale[m];return A>0&&Number.isFinite(b)?Math.round(Math.min(Math.max((b-i.origin[m])/A,0),g)):0}),this.toData=new Float64Array([1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]);for(let m=0;m<3;++m)this.toData[12+m]=i.origin[m]+i.anchor_scale[m]*this.reference[m];this.grow("anchor_texels","rg32ui",o,"anchors"),this.grow("decoding_texels","r32ui",l,"records"),this.grow("code_texels","r32ui",Ke(c.data),"codes"),p&&this.grow("anchor_low_texels","r32ui",Ke(p.data),"anchors");let w=new Uint32Array(4*Math.max(h,1));for(let m=0;m<h;++m)for(let b=0;b<3;++b)w[4*m+b]=d[3*m+b];this.textures.page_texels=O(e,"rgba32ui",w,"pages"),this.coding=new R(e,"Coding"),this.coding.write({anchor_scale:i.anchor_scale,radius_scale:0,step_low:i.step_lo,step_span:i.step_hi-i.step_lo,lattice_edge:i.lattice,end_vector_scale:0,rotation_scales:Ge}),this.rotationBlock=new R(e,"Rotations"),this.rotationBlock.fill(Ye),this.frameForDecoding=new R(e,"Frame"),this.frameForDecoding.write({reference:this.reference},["reference"]),this.feedback=e.createTransformFeedback(),this.decodeArray=e.createVertexArray(),e.bindVertexArray(this.decodeArray),e.enableVertexAttribArray(0),e.bindVertexArray(null)}grow(e,t,n,r){let i=this.textures[e]=re(this.gl,t,t==="rg32ui"?n.length/2:n.length,r);this.growing[e]={texture:i,format:t,data:n}}fill(e,t,n){let r=this.growing[e];r&&X(this.gl,r.texture,r.format,r.data,t,n)}sharesOf(e,t=this.share){let n=F("last",this.growing.decoding_texels.data[3*e+2])+1,r=this.growing.anchor_texels.data[2*e+1]>>>31;return n%t===0&&!r?n/t:Math.ceil((n+(r?1:2))/t)}begin(e){let t=this.gl,r=wt.map(l=>{let c=0,u=0;for(let d=0;d<e;++d){let h=this.sharesOf(d,l);c+=h*l*(1+.05*h),u+=h}return{share:l,cost:c,total:u}}).reduce((l,c)=>c.cost<l.cost?c:l),i=this.fiblets-e;this.share=r.share,this.itemBytes=this.share*ae;let s=this.points;for(let l=0;l<e;++l)s-=F("last",this.growing.decoding_texels.data[3*l+2])+1;let o=Math.max(r.total+Math.floor((Math.max(s,0)+(this.share+1)*i)/this.share),1);this.toItems=new Uint32Array(4*o),this.textures.items=re(t,"rgba32ui",o,"shares of fiblets"),this.itemBuffer=t.createBuffer(),t.bindBuffer(t.ARRAY_BUFFER,this.itemBuffer),t.bufferData(t.ARRAY_BUFFER,8*o,t.STATIC_DRAW)}advance(e){let t=this.gl,n=this.done,r=Math.min(e,this.fiblets),i=this.parameters,{table:s}=this;if(r<=n&&this.fiblets)return;n||this.begin(r);let o=this.archive.arrays.get("rank_to_id.npy")?.data,l=this.archive.arrays.get("anchors_low.npy")?.data,c=this.growing.anchor_texels.data,u=this.growing.decoding_texels.data,d=this.toItems,h=s[s.length-2],p=this.shares,g=2*i.largest_radius,w=this.kinds.size,m=p,b=this.open,A=0;for(let y=n;y<r;++y)A+=this.sharesOf(y);let T=new Uint32Array(2*A),z=()=>{b&&(b.more=1,this.blocks.push(b))};for(let y=n;y<r;++y){let K=3*(y>>G),N=c[2*y+1],ve=u[3*y+2],Re=F("rank",N)+s[K],ce=F("last",ve)+1,we=o?Number(o[Re]):Re,Le=F("begin",N),Ze=F("end",N),$e=F("code",u[3*y+1])+s[K+1],De=F("point",ve)+s[K+2],ye=this.sharesOf(y);if(ce>60||4*(m+ye)>d.length||!(we>=0&&we<this.streamlines)||$e>h||De+ce>this.points)throw new x(`Record ${y} of the file is damaged. Copy or make it again.`);this.kinds.add(F("kind",ve)),y%vt===0&&(z(),b={firstItem:m,items:0,more:0,bounds:[1/0,-1/0,1/0,-1/0,1/0,-1/0],buffer:null,used:0});let Se=[c[2*y]&65535,c[2*y]>>>16,N&65535];for(let E=0;E<3;++E){let Ce=i.origin[E]+i.anchor_scale[E]*(l?Se[E]*65536+l[3*y+E]:Se[E]);b.bounds[2*E]=Math.min(b.bounds[2*E],Ce-g),b.bounds[2*E+1]=Math.max(b.bounds[2*E+1],Ce+g)}Le&&(this.before=0);for(let E=0;E<ye;++E,++m)d[4*m]=we,d[4*m+1]=De,d[4*m+2]=ce|Le<<6|Ze<<7|E<<8,d[4*m+3]=this.before,T[2*(m-p)]=y,T[2*(m-p)+1]=E;this.before+=ce,b.items+=ye}this.open=b,r===this.fiblets&&b&&this.blocks.push(b),this.shares=m,this.done=r,this.kinds.size>w&&(this.decodeProgram=null),X(t,this.textures.items,"rgba32ui",d,p,m),t.bindBuffer(t.ARRAY_BUFFER,this.itemBuffer),t.bufferSubData(t.ARRAY_BUFFER,8*p,T),this.fill("anchor_texels",n,r),this.fill("decoding_texels",3*n,3*r),this.fill("anchor_low_texels",Math.floor(1.5*n),Math.ceil(1.5*r)),this.fill("code_texels",this.countBefore(n,1)>>2,this.countBefore(r,1)+3>>2);for(let{texture:y,format:K,data:N}of this.values)X(t,y,K,N,this.countBefore(n,2),this.countBefore(r,2))}countBefore(e,t){return this.table[3*Math.ceil(e/(1<<G))+t]}pointValues(e){let t=this.archive.header.per_point?.[e],n=t&&this.archive.arrays.get(t.member);if(!n||n.data.length!==this.points)throw new x(`The file has no values ${e} for its points.`);let r=n.data instanceof Uint16Array,i=r?65535:255,s=r?"r16ui":"r8ui",o=n.data,l=re(this.gl,s,this.points,"values of points");return this.values.push({texture:l,format:s,data:o}),X(this.gl,l,s,o,0,this.countBefore(this.done,2)),{name:e,texture:l,code:[t.lo,(t.hi-t.lo)/(i-1),i]}}decoder(){let e=["DIRECTION"];return this.textures.anchor_low_texels&&e.push("ANCHORS_LOW"),(this.kinds.size>1||!this.kinds.has(Xe))&&e.push("LATTICE"),this.kinds.has(yt)&&e.push("WIDE_LATTICE"),this.decodeProgram??(this.decodeProgram=new q(this.gl,"page/decode.vert","page/none.frag",e,Array.from({length:this.share},(t,n)=>`o${n}`)))}decode(e,t){let n=this.gl,r=e.items+e.more;this.coding.bind(),this.rotationBlock.bind(),this.frameForDecoding.bind();let{items:i,...s}=this.textures;this.decoder().use().textures(s).uints({chunk_fiblets:this.fiblets,share_size:this.share}),n.bindVertexArray(this.decodeArray),n.bindBuffer(n.ARRAY_BUFFER,this.itemBuffer),n.vertexAttribIPointer(0,2,n.UNSIGNED_INT,8,8*e.firstItem),n.bindBuffer(n.ARRAY_BUFFER,null),n.enable(n.RASTERIZER_DISCARD),n.bindTransformFeedback(n.TRANSFORM_FEEDBACK,this.feedback),n.bindBufferRange(n.TRANSFORM_FEEDBACK_BUFFER,0,t,0,r*this.itemBytes),n.beginTransformFeedback(n.POINTS),n.drawArrays(n.POINTS,0,r),n.endTransformFeedback(),n.bindBufferBase(n.TRANSFORM_FEEDBACK_BUFFER,0,null),n.bindTransformFeedback(n.TRANSFORM_FEEDBACK,null),n.disable(n.RASTERIZER_DISCARD),n.bindVertexArray(null)}size(e){return(e.items+e.more)*this.itemBytes+2*ae}newBuffer(e){let t=this.gl,n=t.createBuffer();return t.bindBuffer(t.ARRAY_BUFFER,n),t.bufferData(t.ARRAY_BUFFER,e,t.DYNAMIC_COPY),t.bindBuffer(t.ARRAY_BUFFER,null),n}pointsOf(e){if(e.used=++this.clock,e.buffer)return e.buffer;let t=this.size(e);return this.held+t<=this.budget?(this.held+=t,e.buffer=this.newBuffer(t),this.decode(e,e.buffer),e.buffer):(this.scratchBytes<t&&(this.scratch&&this.gl.deleteBuffer(this.scratch),this.scratch=this.newBuffer(this.scratchBytes=t)),this.decode(e,this.scratch),this.scratch)}get items(){return this.textures.items}instances(e){return e.items*this.share}get longestStep(){return this.kinds.size===1&&this.kinds.has(Xe)?2*this.parameters.step_hi:1/0}draw(e,t,n,r){let i=this.gl,s=this.pointsOf(e);t.use().ints({first_item:e.firstItem,share_size:this.share}),i.bindVertexArray(this.segmentArray(r)),i.bindBuffer(i.ARRAY_BUFFER,s);for(let l=0;l<3;++l)i.vertexAttribIPointer(l,4,i.UNSIGNED_INT,ae,l*ae);let o=Math.max(1,Math.round(e.items*n))*this.share;return r?i.drawArrays(i.POINTS,0,o):i.drawArraysInstanced(i.TRIANGLE_STRIP,0,4,o),i.bindVertexArray(null),o}segmentArray(e){let t=e?1:0;if(!this.arrays[t]){let n=this.gl;n.bindVertexArray(this.arrays[t]=n.createVertexArray());for(let r=0;r<3;++r)n.enableVertexAttribArray(r),n.vertexAttribDivisor(r,e?0:1)}return this.arrays[t]}*decoded(e){let t=this.gl,n=this.toItems;for(let r of this.blocks){if(!e(r))continue;let i=new Float32Array((r.items+r.more)*this.share*4);t.bindBuffer(t.ARRAY_BUFFER,this.pointsOf(r)),t.getBufferSubData(t.ARRAY_BUFFER,0,i),t.bindBuffer(t.ARRAY_BUFFER,null);for(let s=r.firstItem;s<r.firstItem+r.items;++s){if(n[4*s+2]>>>8)continue;let o=n[4*s+2]&63,l=(n[4*s+2]&128)!==0,c=4*this.share*(s-r.firstItem);yield[n[4*s],i.subarray(c,c+4*(o+(l?0:1))),(n[4*s+2]&64)!==0]}}}blocksOf(e){let t=this.toItems;return n=>{for(let r=n.firstItem;r<n.firstItem+n.items;++r)if(t[4*r]===e)return!0;return!1}}world(e,t){return[0,1,2].map(n=>this.toData[12+n]+e[4*t+n])}pointsOfStreamline(e){let t=[];for(let[n,r]of this.decoded(this.blocksOf(e)))if(n===e)for(let i=0;4*i<r.length;++i)t.push(this.world(r,i));return t}through(e,t){let n=new Uint8Array(this.streamlines),r=[0,1,2].map(o=>e[o]-this.toData[12+o]),i=t*t,s=o=>[0,1,2].every(l=>e[l]+t>=o.bounds[2*l]&&e[l]-t<=o.bounds[2*l+1]);for(let[o,l]of this.decoded(s))if(!n[o])for(let c=0;c<l.length;c+=4){let u=Math.min(c+4,l.length-4),d=l[u]-l[c],h=l[u+1]-l[c+1],p=l[u+2]-l[c+2],g=r[0]-l[c],w=r[1]-l[c+1],m=r[2]-l[c+2],b=Math.min(1,Math.max(0,(g*d+w*h+m*p)/(d*d+h*h+p*p||1))),A=g-b*d,T=w-b*h,z=m-b*p;if(A*A+T*T+z*z<=i){n[o]=1;break}}return n}release(){let e=this.gl;for(let t of this.blocks)t.buffer&&e.deleteBuffer(t.buffer);for(let t of Object.values(this.textures))e.deleteTexture(t);this.scratch&&e.deleteBuffer(this.scratch),e.deleteBuffer(this.itemBuffer)}};function At(a,e,t){let n=e.slice(0,6).map(r=>[0,1,2,3].map(i=>r[0]*t[4*i]+r[1]*t[4*i+1]+r[2]*t[4*i+2]+r[3]*t[4*i+3]));a.ints({plane_count:n.length}),n.forEach((r,i)=>a.set({[`planes[${i}]`]:r}))}var ge=class{constructor(e,t,n){f(this,"gl",e);f(this,"layer",t);f(this,"array");f(this,"buffers",[]);f(this,"count");f(this,"table",null);f(this,"tableRange",[0,1,1,1]);f(this,"model");this.model=new Float64Array(t.matrix??[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]),this.array=e.createVertexArray(),e.bindVertexArray(this.array);let r=(s,o,l,c,u)=>{let d=e.createBuffer();e.bindBuffer(e.ARRAY_BUFFER,d),e.bufferData(e.ARRAY_BUFFER,o,e.STATIC_DRAW),e.enableVertexAttribArray(s),e.vertexAttribPointer(s,l,c,u,0,0),this.buffers.push(d)};r(0,n[t.places],3,e.FLOAT,!1),t.normals!==void 0&&r(1,n[t.normals],3,e.FLOAT,!1),t.colours!==void 0&&r(2,n[t.colours],4,e.UNSIGNED_BYTE,!0),t.values!==void 0&&(r(3,n[t.values],1,e.FLOAT,!1),[this.table,this.tableRange]=pe(e,B(t.table),t.clim,!!t.log));let i=e.createBuffer();e.bindBuffer(e.ELEMENT_ARRAY_BUFFER,i),e.bufferData(e.ELEMENT_ARRAY_BUFFER,n[t.triangles],e.STATIC_DRAW),this.buffers.push(i),this.count=n[t.triangles].byteLength/4,e.bindVertexArray(null)}get translucent(){return this.layer.opacity<1}draw(e,t){let n=this.gl,{layer:r}=this,i=_(t.view,this.model),s=ee(i),o=$(i),l=o?[o[0],o[4],o[8],o[1],o[5],o[9],o[2],o[6],o[10]]:s;e.use().set({clip_from_data:de(_(t.projection,i)),view_from_data:de(i),normal_to_view:l,parallel:t.parallel?1:0,opacity:r.opacity,reflects:r.reflects,sheen:r.sheen}),e.ints({smooth_normals:r.normals===void 0?0:1,lighting:r.lighting?1:0,by_value:this.table?1:0,logarithm:r.log?1:0}),e.textures({table:this.table}).set({table_range:this.tableRange}),t.lights(e),At(e,[...r.planes??[],...t.planes],this.model),n.bindVertexArray(this.array),r.normals===void 0&&n.vertexAttrib3f(1,0,0,1),r.colours===void 0&&n.vertexAttrib4f(2,r.colour[0],r.colour[1],r.colour[2],1),n.drawElements(n.TRIANGLES,this.count,n.UNSIGNED_INT,0),n.bindVertexArray(null)}release(){for(let e of this.buffers)this.gl.deleteBuffer(e);this.gl.deleteVertexArray(this.array),this.table&&this.gl.deleteTexture(this.table)}depth(e){let t=this.layer.bounds,n=[(t[0]+t[1])/2,(t[2]+t[3])/2,(t[4]+t[5])/2];return-(e[2]*n[0]+e[6]*n[1]+e[10]*n[2]+e[14])}},be=class{constructor(e,t,n){f(this,"gl",e);f(this,"layer",t);f(this,"texture");let[r,i]=t.size;this.texture=e.createTexture(),e.bindTexture(e.TEXTURE_2D,this.texture),e.texImage2D(e.TEXTURE_2D,0,e.RGBA8,r,i,0,e.RGBA,e.UNSIGNED_BYTE,n[t.pixels]);for(let s of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])e.texParameteri(e.TEXTURE_2D,e[s],e.NEAREST);for(let s of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])e.texParameteri(e.TEXTURE_2D,e[s],e.CLAMP_TO_EDGE)}release(){this.gl.deleteTexture(this.texture)}draw(e,t){let{layer:n}=this;e.use().set({clip_from_data:de(_(t.projection,t.view)),corner:n.corner,across:n.across,up:n.up,opacity:n.opacity}),e.textures({pixels:this.texture}),this.gl.bindVertexArray(null),this.gl.drawArrays(this.gl.TRIANGLE_STRIP,0,4)}};var xt=60,We=45,Et=400,_t=40,oe=4294967295,Tt={direction:0,solid:1,streamline:2,value:3,point:4},Ft={none:0,line:1,illuminated:2},ke=class{constructor(e,t,n,r,i,s){f(this,"gl",e);f(this,"layer",t);f(this,"index",n);f(this,"set");f(this,"model");f(this,"values",null);f(this,"colours",null);f(this,"table",null);f(this,"tableRange",[0,1,1,1]);f(this,"kept",null);f(this,"chosen",null);f(this,"shownValues",[1,0]);f(this,"marked",oe);this.set=s??new me(e,i),this.set.advance(i.ready),this.model=new Float64Array(t.matrix??_e());let{colours:o}=t;o.values!==void 0&&(this.values=this.set.pointValues(o.values)),o.data!==void 0&&(this.colours=O(e,"rgba8",r[o.data],"colours")),o.table!==void 0&&([this.table,this.tableRange]=pe(e,B(o.table),o.clim,!!o.log)),t.kept!==void 0&&this.keep(r[t.kept]),t.chosen&&(this.chosen=O(e,"r8ui",r[t.chosen.data],"streamlines"))}release(){for(let e of[this.values?.texture,this.colours,this.table,this.kept,this.chosen])e&&this.gl.deleteTexture(e)}get byPoint(){return this.layer.colours.mode==="point"}keep(e){this.kept&&this.gl.deleteTexture(this.kept),this.kept=e&&O(this.gl,"r8ui",e,"streamlines")}},le=class{constructor(e,t,n,r){f(this,"canvas",e);f(this,"scene",t);f(this,"data",n);f(this,"archives",r);f(this,"camera");f(this,"lines",[]);f(this,"surfaces",[]);f(this,"images",[]);f(this,"planes",[]);f(this,"width",0);f(this,"height",0);f(this,"ratio",1);f(this,"frames",0);f(this,"loading",!1);f(this,"failed",null);f(this,"drawnOnce",null);f(this,"presented",null);f(this,"finished",null);f(this,"gl");f(this,"programs",new Map);f(this,"frameBlock");f(this,"clipBlock");f(this,"textures",{});f(this,"buffers",{});f(this,"frame",null);f(this,"rest",null);f(this,"sync",null);f(this,"sliceStarted",0);f(this,"sliceSize",0);f(this,"rate",1e3);f(this,"dirty",!0);f(this,"moving",!1);f(this,"asked",0);f(this,"still",0);f(this,"waiting",[]);f(this,"restored",null);this.camera=new fe(structuredClone(t.camera));let i=e.getContext("webgl2",{alpha:!1,antialias:!1,depth:!1,preserveDrawingBuffer:!1,powerPreference:"high-performance"});if(!i)throw new V("This browser has no WebGL 2, which the page draws with. Turn on graphics acceleration in its settings, or open the page in another browser.");this.gl=i,e.addEventListener("webglcontextlost",s=>{s.preventDefault(),this.frame=this.rest=null,this.sync=null}),e.addEventListener("webglcontextrestored",()=>this.guarded(()=>this.begin())),this.begin()}guarded(e){try{e()}catch(t){this.gl.isContextLost()||this.failed?.(t)}}begin(){let{gl:e}=this,t=this.lines.splice(0);this.programs.clear(),this.rest=null,this.textures={},this.buffers={},this.width=this.height=0,this.surfaces.length=this.images.length=0,this.frameBlock=new R(e,"Frame"),this.clipBlock=new R(e,"ClipPlanes"),this.fill(new Map,new Map),t.forEach((n,r)=>{let i=this.lines[r];i.shownValues=n.shownValues,i.marked=n.marked}),this.restored?.(),this.change()}fill(e,t){let{gl:n,scene:r}=this;r.layers.forEach(s=>{s.kind==="surface"?this.surfaces.push(t.get(JSON.stringify(s))??new ge(n,s,this.data)):s.kind==="image"?this.images.push(new be(n,s,this.data)):this.lines.push(new ke(n,s,this.lines.length,this.data,this.archives.get(s.data),e.get(this.data[s.data])))});let i=Math.min(1024,128*(navigator.deviceMemory??4))*2**20;for(let s of this.lines)s.set.budget=i/this.lines.length}update(e,t,n){if(this.gl.isContextLost())return;let{data:r}=this,i=this.lines.splice(0),s=this.surfaces.splice(0),o=this.images.splice(0),l=new Map(i.map(u=>[r[u.layer.data],u.set])),c=u=>[u.layer.places,u.layer.triangles,u.layer.normals,u.layer.colours,u.layer.values].every(d=>d===void 0||r[d]===t[d]);this.frame=this.rest=null,this.scene=e,this.data=t,this.archives=n,this.fill(l,new Map(s.filter(c).map(u=>[JSON.stringify(u.layer),u])));for(let u of[...i,...o])u.release();for(let{set:u}of i)this.lines.some(d=>d.set===u)||u.release();for(let u of s)this.surfaces.includes(u)||u.release();this.change()}program(e,t,n=[]){let r=[e,t,...n].join(" "),i=this.programs.get(r);return i||this.programs.set(r,i=new q(this.gl,e,t,n)),i}change(e=!1){this.dirty=!0,this.moving=e,window.clearTimeout(this.still),e&&(this.still=window.setTimeout(()=>this.change(),200)),this.schedule()}grow(){this.guarded(()=>{let e=this.frame??this.rest;for(let t of this.lines){let{set:n}=t,r=n.blocks.length;n.advance(this.archives.get(t.layer.data).ready),e&&t.layer.visible&&this.addJobs(e,t,n.blocks.slice(r))}e?this.dirty||(this.frame=e):this.change()}),this.schedule()}addJobs(e,t,n){let r=_(e.matrices.projection,_(e.matrices.view,t.model));for(let i of n)this.outside(r,i.bounds)||e.jobs.push({lines:t,block:i})}schedule(){this.asked||(this.asked=requestAnimationFrame(()=>this.guarded(()=>this.tick())))}settled(){return!this.dirty&&!this.frame&&!this.loading?Promise.resolve():new Promise(e=>this.waiting.push(e))}tick(){this.asked=0;let{gl:e}=this;if(e.isContextLost())return;if(this.sync){if(e.getSyncParameter(this.sync,e.SYNC_STATUS)!==e.SIGNALED)return this.schedule();e.deleteSync(this.sync),this.sync=null;let i=Math.max(performance.now()-this.sliceStarted,.5);this.sliceSize>2e3&&(this.rate+=.5*(Math.min(this.sliceSize/i,8*this.rate)-this.rate))}this.fit(),this.dirty&&this.start();let t=this.frame;if(!t)return;let n=this.rate*(t.moving?We:xt);this.sliceStarted=performance.now(),this.sliceSize=0,this.drawSlice(t,t.moving?1/0:n);let r=t.next>=t.jobs.length;(r||performance.now()-t.shownAt>Et)&&(t.shownAt=performance.now(),this.present(t.matrices,r),this.drawnOnce&&(t.jobs.length||!this.loading)&&(this.drawnOnce(),this.drawnOnce=null)),this.sync=e.fenceSync(e.SYNC_GPU_COMMANDS_COMPLETE,0),e.flush(),r&&(this.frame=null,this.rest=t.moving?null:t,++this.frames,t.moving||this.finished?.(),!t.moving&&!this.dirty&&!this.loading&&this.waiting.splice(0).forEach(i=>i())),this.schedule()}fit(){let{gl:e,canvas:t}=this,n=window.devicePixelRatio||1,r=e.getParameter(e.MAX_TEXTURE_SIZE)-2,i=Math.min(r,Math.max(1,Math.round(t.clientWidth*n))),s=Math.min(r,Math.max(1,Math.round(t.clientHeight*n)));if(i===this.width&&s===this.height)return;t.width=this.width=i,t.height=this.height=s,this.ratio=n;for(let l of Object.values(this.textures))e.deleteTexture(l);for(let l of Object.values(this.buffers))e.deleteFramebuffer(l);let o=this.textures={texels:ie(e,e.RGBA32UI,i,s),depths:ie(e,e.DEPTH_COMPONENT32F,i,s),drawn:ie(e,e.RGBA8,i,s),shown:ie(e,e.RGBA32UI,i+2,s+2)};this.buffers={texels:se(e,o.texels,o.depths),scene:se(e,o.drawn,o.depths),drawn:se(e,o.drawn,null),shown:se(e,o.shown,null)},this.dirty=!0}start(){let{gl:e,camera:t,scene:n}=this,r=this.moving;this.dirty=!1;let i=t.view(),s=t.projection(this.width/this.height,n.bounds),o={view:i,projection:s,parallel:t.state.parallel,lights:u=>this.setLights(u,i),planes:this.planes},l=this.frame={jobs:[],next:0,share:1,drawn:0,shownAt:performance.now(),matrices:o,moving:r};this.rest=null;for(let u of this.lines)u.layer.visible&&this.addJobs(l,u,u.set.blocks);let c=l.jobs.reduce((u,{lines:d,block:h})=>u+d.set.instances(h),0);r&&(l.share=Math.min(1,this.rate*We/Math.max(c,1))),this.frames||(l.shownAt=0),e.viewport(0,0,this.width,this.height),e.disable(e.BLEND),e.disable(e.CULL_FACE),e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.texels),e.clearBufferuiv(e.COLOR,0,[oe,oe,0,0]),e.depthMask(!0),e.clearBufferfv(e.DEPTH,0,[1]),this.drawBackdrop(o)}drawBackdrop(e){let{gl:t,scene:n}=this;t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.scene),t.disable(t.DEPTH_TEST),t.bindVertexArray(null),this.program("page/screen.vert","page/background.frag").use().set({bottom:n.background[0],top:n.background[1],height:this.height}),t.drawArrays(t.TRIANGLES,0,3),t.enable(t.DEPTH_TEST),t.depthFunc(t.LEQUAL),t.depthMask(!0);let r=this.program("page/surface.vert","page/surface.frag");for(let s of this.surfaces)s.layer.visible&&!s.translucent&&s.draw(r,e);let i=this.program("page/image.vert","page/image.frag");for(let s of this.images)s.layer.visible&&s.layer.opacity>=1&&s.draw(i,e)}outside(e,t){let n=[0,0,0,0,0,0];for(let r=0;r<8;++r){let[i,s,o,l]=S(e,[t[r&1],t[2+(r>>1&1)],t[4+(r>>2)]]);[i<-l,i>l,s<-l,s>l,o<-l,o>l].forEach((c,u)=>n[u]+=c?1:0)}return n.some(r=>r===8)}setLights(e,t){let n=[0,0,0],r=0;this.scene.lights.slice(0,8).forEach((i,s)=>{let o=[0,0,1,0];i.view?o=[...i.view,0]:i.world&&(r=1,o=S(t,i.world,i.positional?1:0),o[3]=i.positional?1:0),e.set({[`light_colour[${s}]`]:i.colour,[`light_place[${s}]`]:o}),i.colour.forEach((l,c)=>n[c]+=l)}),e.ints({light_count:Math.min(this.scene.lights.length,8)}).set({light_sum:n,light_standing:r})}aim(e,t){let n=e.layer.line_width*this.ratio,r=n>1,i=_(t.view,_(e.model,e.set.toData)),s=_(t.projection,i),o=s.reduce((u,d)=>Math.max(u,Math.abs(d)),0)||1,l=new Float64Array(16);for(let u=0;u<4;++u){let[d,h,p,g]=[0,1,2,3].map(w=>s[w+4*u]/o);l.set([this.width/2*(d+g),this.height/2*(h+g),(p+g)/2,g],4*u)}this.frameBlock.write({window_from_local:l,reference:e.set.reference,half_line_width:r?n/2:0,viewport:[this.width,this.height]},["reference"]),this.frameBlock.bind();let c=[...e.layer.planes??[],...this.planes].slice(0,8);if(c.length){let u=_(e.model,e.set.toData),d=$(s),h=new Float64Array(32),p=new Float64Array(32);c.forEach((g,w)=>{let m=[0,1,2,3].map(A=>g[0]*u[4*A]+g[1]*u[4*A+1]+g[2]*u[4*A+2]+g[3]*u[4*A+3]),b=Math.hypot(m[0],m[1],m[2])||1;if(m.forEach((A,T)=>h[4*w+T]=A/b),d)for(let A=0;A<2;++A){let T=[0,1,2,3].reduce((z,y)=>z+h[4*w+y]*d[y+4*A],0);p[4*w+A]=T*o*(2/(A===0?this.width:this.height))}}),this.clipBlock.write({clip_planes:h,clip_tilts:p,clip_plane_count:0,clip_rounding:0}),this.clipBlock.write({clip_plane_count:c.length},["clip_plane_count"]),this.clipBlock.bind()}return{wide:r,clipped:c.length>0}}pixelsOf(e,t,n){let r=_(t.projection,_(t.view,e.model)),i=e.set.bounds,s=Math.hypot(...ee(e.model)),o=1/0;for(let l=0;l<8;++l)o=Math.min(o,S(r,[i[l&1],i[2+(l>>1&1)],i[4+(l>>2)]])[3]);return o>0?n*s*(this.height/2)*t.projection[5]/o:1/0}drawSlice(e,t){let{gl:n}=this,r=null,i=null,s=!1;for(;e.next<e.jobs.length&&this.sliceSize<t;){let{lines:o,block:l}=e.jobs[e.next++];if(o.set.pointsOf(l),r!==o){r=o;let{wide:c,clipped:u}=this.aim(o,e.matrices),d=["CLIPPING","CLIPPING_DEPTH","EDGES"];c&&d.push("WIDE_LINES"),u&&d.push("CLIP_PLANES"),s=!c&&this.pixelsOf(o,e.matrices,o.set.longestStep)<=_t,s&&d.push("SPRITES"),o.values&&d.push("VALUES_STORED"),o.byPoint&&d.push("VALUES_COLOUR"),o.kept&&d.push("STREAMLINE_MASK"),i=this.program("page/segment.vert","page/segment.frag",d).use(),o.values&&i.set({value_code:o.values.code,shown_values:o.shownValues}),i.uints({layer:o.index*2**28})}n.bindFramebuffer(n.FRAMEBUFFER,this.buffers.texels),n.enable(n.DEPTH_TEST),n.depthFunc(n.LESS),this.frameBlock.bind(),i.use().textures({items:o.set.items,kept:o.kept,value_texels:o.values&&o.values.texture,point_colours:o.byPoint?o.colours:null}),this.sliceSize+=o.set.draw(l,i,e.share,s)}}present(e,t){let{gl:n,textures:r,buffers:i}=this;this.repaint(e),n.disable(n.DEPTH_TEST),n.bindFramebuffer(n.FRAMEBUFFER,i.drawn),n.bindVertexArray(null);let s=this.program("page/screen.vert","page/resolve.frag").use(),o=$(e.projection)??_e(),l=0;for(let c of this.lines){if(!c.layer.visible)continue;let{layer:u}=c,{colours:d}=u,h=u.line_width*this.ratio;l=Math.max(l,1-Math.min(1,h)),s.textures({texels:r.texels,depths:r.depths,colours:c.byPoint?null:c.colours,table:c.table,chosen:c.chosen??r.texels}),s.uints({layer:c.index*2**28,marked:c.marked}),s.ints({mode:Tt[d.mode],logarithm:d.log?1:0,light:Ft[u.light]}),s.set({one_colour:d.colour??[1,1,1],table_range:c.tableRange,reflects:u.reflects,sheen:u.sheen,chosen_colour:u.chosen?.colour??[0,0,0,0],faded:u.chosen?.faded??[0,0,0,0],data_to_view:ee(_(e.view,c.model)),pixel_to_view:new Float32Array(o),picture:[this.width,this.height]}),this.setLights(s,e.view),n.drawArrays(n.TRIANGLES,0,3)}if(this.drawTranslucent(e),n.disable(n.DEPTH_TEST),n.bindVertexArray(null),t&&this.scene.antialias&&this.lines.length){n.bindFramebuffer(n.FRAMEBUFFER,i.shown),n.viewport(0,0,this.width+2,this.height+2),this.program("page/screen.vert","page/visible_edges.frag").use().textures({texels:r.texels,depths:r.depths,drawn:r.drawn}).set({narrower:l}),n.drawArrays(n.TRIANGLES,0,3),n.viewport(0,0,this.width,this.height),n.bindFramebuffer(n.FRAMEBUFFER,i.drawn);let c=this.program("page/screen.vert","effects/picture/antialias_coverage.frag").use().textures({shown:r.shown});n.uniform2i(c.at("shift"),1,1),n.drawArrays(n.TRIANGLES,0,3)}n.bindFramebuffer(n.FRAMEBUFFER,null),this.program("page/screen.vert","page/copy.frag").use().textures({drawn:r.drawn}),n.drawArrays(n.TRIANGLES,0,3),this.presented?.()}repaint(e){this.frame&&this.frame.drawn++>0&&this.drawBackdrop(e)}drawTranslucent(e){let{gl:t}=this,n=this.surfaces.filter(o=>o.layer.visible&&o.translucent),r=this.images.filter(o=>o.layer.visible&&o.layer.opacity<1);if(!n.length&&!r.length)return;t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.scene),t.enable(t.DEPTH_TEST),t.depthFunc(t.LEQUAL),t.depthMask(!1),t.enable(t.BLEND),t.blendFunc(t.SRC_ALPHA,t.ONE_MINUS_SRC_ALPHA);let i=this.program("page/surface.vert","page/surface.frag");n.sort((o,l)=>l.depth(e.view)-o.depth(e.view)).forEach(o=>o.draw(i,e));let s=this.program("page/image.vert","page/image.frag");r.forEach(o=>o.draw(s,e)),t.disable(t.BLEND),t.depthMask(!0)}pick(e,t){let{gl:n}=this,r=Math.floor(e*this.ratio),i=this.height-1-Math.floor(t*this.ratio),s=new Uint32Array(4),o=[[0,0],[1,0],[-1,0],[0,1],[0,-1],[2,0],[-2,0],[0,2],[0,-2]];for(let[l,c]of o){if(r+l<0||i+c<0||r+l>=this.width||i+c>=this.height||(n.bindFramebuffer(n.FRAMEBUFFER,this.buffers.texels),n.readPixels(r+l,i+c,1,1,n.RGBA_INTEGER,n.UNSIGNED_INT,s),s[0]===oe&&s[1]===oe))continue;let u=this.lines[s[0]>>>28];if(!u)continue;let d=u.values?new Float32Array(new Uint32Array([s[3]]).buffer)[0]:null;return{lines:u,streamline:s[0]&268435455,value:d}}return null}placeOf(e,t,n,r){let{camera:i,scene:s,canvas:o}=this,l=o.clientWidth,c=o.clientHeight,u=_(i.projection(this.width/this.height,s.bounds),_(i.view(),e.model)),d=[0,0,0],h=1/0;for(let p of e.set.pointsOfStreamline(t)){let[g,w,,m]=S(u,p),b=Math.hypot((g/m+1)*l/2-n,(1-w/m)*c/2-r);m>0&&b<h&&([d,h]=[p,b])}return d}pixels(){let{gl:e,width:t,height:n}=this,r=new Uint8Array(4*t*n),i=new Uint8Array(r.length);e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.drawn),e.readPixels(0,0,t,n,e.RGBA,e.UNSIGNED_BYTE,r);for(let s=0;s<n;++s)i.set(r.subarray(4*t*s,4*t*(s+1)),4*t*(n-1-s));return i}};var Je=a=>document.getElementById(a)?.textContent??"",H=4;async function Bt(a){let e=new Set(a.layers.map(t=>t.kind==="fiblets"?t.data:-1));return Promise.all(a.data.map(async(t,n)=>{if(t.file===void 0)return B(Je(`data-${n}`).trim());if(e.has(n))return new Uint8Array;let r=new ne(t.file,t.bytes);return await r.need(0,t.bytes),r.bytes}))}async function It(a,e,t){let n=new Map;return await Promise.all(a.layers.map(async r=>{if(r.kind!=="fiblets")return;let{file:i,bytes:s}=a.data[r.data];if(i===void 0){n.set(r.data,xe(e[r.data]));return}let o=new ne(i,s),l=r.colours.values===void 0?[]:[r.colours.values],c=await ze(o,l);n.set(r.data,c),t.push({archive:c,remote:o,values:l})})),n}async function kt(a,e){let t=document.createElement("progress"),n=1<<G;t.setAttribute("aria-label","Streamlines that have come"),t.max=a.reduce((r,{archive:i})=>r+i.header.n_fiblets,0),document.getElementById("over").append(t),await Promise.all(a.map(async({archive:r,remote:i,values:s})=>{let o=r.header.n_fiblets,l=Math.ceil(o/n),c=d=>Ne(i,r,d,Math.min(d+H,l),n,s),u=c(0);for(let d=0;d<l;d+=H){let h=u;d+H<l&&(u=c(d+H)).catch(()=>{}),await h,t.value+=Math.min((d+H)*n,o)-r.ready,r.ready=Math.min((d+H)*n,o),e.grow()}})),t.remove()}function je(a){let e=document.getElementById("message");e.textContent=a instanceof Error?a.message:String(a),e.hidden=!1,document.body.dataset.state="failed"}async function Rt(){let a=JSON.parse(Je("scene"));document.title=a.title;let e=await Bt(a),t=[],n=await It(a,e,t),r=new le(document.getElementById("view"),a,e,n);r.loading=t.length>0,r.failed=je,r.drawnOnce=()=>{document.body.dataset.state="drawn"},new ResizeObserver(()=>r.change()).observe(r.canvas);let i=new he(r,e);if(Fe(r,(s,o)=>i.pick(s,o)),Ve(r,i),window.pvfiblets=r,!!t.length)try{await kt(t,r)}finally{r.loading=!1,r.grow()}}window.pvfibletsPage={Renderer:le,attachMouse:Fe,readArchive:xe};document.getElementById("scene")&&Rt().catch(je);})();
