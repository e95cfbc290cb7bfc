// Built by `make client` of sources 9a22a2249cb8a765
"use strict";(()=>{var Lt=Object.defineProperty;var It=(o,e,t)=>e in o?Lt(o,e,{enumerable:!0,configurable:!0,writable:!0,value:t}):o[e]=t;var f=(o,e,t)=>It(o,typeof e!="symbol"?e+"":e,t);var T=class extends Error{},Ut=101010256,kt=101075792,Mt=117853008,St=33639248,$e=67324752,et="header.json",Ae="Copy or make the file again.",Ot=4096;function ne(o,e){return o.getUint32(e,!0)+o.getUint32(e+4,!0)*4294967296}function Pt(o){let e=o.byteLength;for(let t=e-22;t>=Math.max(0,e-65558);--t)if(o.getUint32(t,!0)===Ut){if(t>=20&&o.getUint32(t-20,!0)===Mt){let n=ne(o,t-12);if(n+56<=e&&o.getUint32(n,!0)===kt)return[ne(o,n+48),ne(o,n+32)]}return[o.getUint32(t+16,!0),o.getUint16(t+10,!0)]}throw new T("This is no whole .fiblets file: the end of its zip archive is missing. Copy or make it again.")}function zt(o,e,t,n){let r=o.getUint32(e+24,!0),i=o.getUint32(e+42,!0),s=o.getUint32(e+20,!0);for(let a=e+46+t,l=a+n;a+4<=l;){let c=o.getUint16(a,!0),u=o.getUint16(a+2,!0),h=a+4;c===1&&(r===4294967295&&(r=ne(o,h),h+=8),s===4294967295&&(s=ne(o,h),h+=8),i===4294967295&&(i=ne(o,h))),a+=4+u}return[r,i]}var tt={"|u1":[1,Uint8Array],"|i1":[1,Int8Array],"|b1":[1,Uint8Array],"<u2":[2,Uint16Array],"<i2":[2,Int16Array],"<u4":[4,Uint32Array],"<i4":[4,Int32Array],"<f4":[4,Float32Array],"<f8":[8,Float64Array],"<i8":[8,BigInt64Array],"<u8":[8,BigUint64Array]};function nt(o,e){let t=tt[o];return t?new t[1](e,0,e.byteLength/t[0]):null}function ze(o,e){let t=new T(`The member ${e} of the file is damaged. ${Ae}`);if(o.length<10||o[0]!==147||o[6]!==1)throw t;let n=o[8]|o[9]<<8,r=new TextDecoder("latin1").decode(o.subarray(10,10+n)),i=/'descr':\s*'([^']+)'/.exec(r),s=/'shape':\s*\(([^)]*)\)/.exec(r);if(!i||!s||/'fortran_order':\s*True/.test(r))throw t;let a=tt[i[1]];if(!a)return null;let l=s[1].split(",").map(p=>p.trim()).filter(p=>p).map(Number),c=l.reduce((p,g)=>p*g,1),u=o.byteOffset+10+n;if(!l.every(p=>Number.isSafeInteger(p)&&p>=0)||10+n+c*a[0]>o.length)throw t;let h=o.buffer,m=u%a[0]===0?new a[1](h,u,c):new a[1](h.slice(u,u+c*a[0]),0,c);return{shape:l,data:m}}function Ne(o){let e=new DataView(o.buffer,o.byteOffset,o.byteLength);if(o.length<22)throw new T("This is no .fiblets file: it is empty, or cut short.");let[t,n]=Pt(e),r=new Map,i=null,s=t;for(let a=0;a<n;++a){if(s+46>o.length||e.getUint32(s,!0)!==St)throw new T(`The list of the file's members is damaged. ${Ae}`);let l=e.getUint16(s+28,!0),c=e.getUint16(s+30,!0),u=e.getUint16(s+32,!0),h=new TextDecoder().decode(o.subarray(s+46,s+46+l)),[m,p]=zt(e,s,l,c);if(e.getUint16(s+10,!0)!==0)throw new T(`The member ${h} of the file is compressed; .fiblets files store their members as they are.`);if(p+30>o.length||e.getUint32(p,!0)!==$e)throw new T(`The member ${h} of the file is damaged. ${Ae}`);let g=p+30+e.getUint16(p+26,!0)+e.getUint16(p+28,!0);if(g+m>o.length)throw new T(`The file ends within its member ${h}. Copy or make it again.`);let v=o.subarray(g,g+m);if(h===et)i=rt(v);else{let d=ze(v,h);d&&r.set(h,d)}s+=46+l+c+u}return it(i,r,1/0)}function rt(o){try{return JSON.parse(new TextDecoder().decode(o))}catch{throw new T(`The file's header is damaged. ${Ae}`)}}function it(o,e,t){if(o===null||typeof o!="object")throw new T("This is a zip archive, but no .fiblets file: it has no header.json.");return{header:o,arrays:e,ready:t}}async function st(o,e){let{bytes:t}=o,n=new DataView(t.buffer,t.byteOffset,t.byteLength),r=new Map,i=null;for(let s=0;s+30<=t.length&&(await o.need(s,Math.min(s+Ot,t.length)),n.getUint32(s,!0)===$e);){let a=n.getUint16(s+26,!0),l=n.getUint16(s+28,!0),c=s+30+a+l,u=new TextDecoder().decode(t.subarray(s+30,s+30+a)),h=n.getUint32(s+18,!0);for(let m=s+30+a;h===4294967295&&m+20<=c;m+=4+n.getUint16(m+2,!0))n.getUint16(m,!0)===1&&(h=ne(n,m+4));if(n.getUint16(s+8,!0)!==0||c+h>t.length)throw new T(`The member ${u} of the file is damaged. ${Ae}`);if(u===et)await o.need(c,c+h),i=rt(t.subarray(c,c+h));else{let m=ze(t.subarray(c,c+h),u);m&&r.set(u,m),m&&(m.data.buffer!==t.buffer||u==="pages.npy"||u.startsWith("table/"))&&(await o.need(c,c+h),r.set(u,ze(t.subarray(c,c+h),u)))}if(r.has("codes.npy")&&e.every(m=>r.has(i?.per_point?.[m]?.member)))break;s=c+h}return it(i,r,0)}var Nt=[["anchors.npy",2,-1],["decoding.npy",3,-1],["anchors_low.npy",3,-1],["rank_to_id.npy",1,0],["codes.npy",1,1]];async function ot(o,e,t,n,r,i){let s=e.arrays.get("pages.npy").data,a=e.header.n_fiblets,l=[...Nt,...i.map(c=>[e.header.per_point?.[c]?.member,1,2])];await Promise.all(l.map(([c,u,h])=>{let m=e.arrays.get(c)?.data;if(!m)return;let[p,g]=[t,n].map(v=>(h<0?Math.min(v*r,a)*u:Number(s[3*v+h]))*m.BYTES_PER_ELEMENT);return o.need(m.byteOffset+p,Math.min(m.byteOffset+g+(h===1?4:0),o.bytes.length))}))}var Ge=1<<17,Qe=11,ge=1<<Qe,Gt=15,Qt=65280;function Vt(o,e){let t=new Uint16Array(e*ge).fill(Qt),n=(r,i,s,a)=>{for(let l=s;l<ge;l+=1<<a)t[r*ge+l]=a<<8|i};for(let r=0;r<e;++r){let i=a=>o[128*r+(a>>1)]>>4*(a&1)&15,s=0;for(let a=1;a<=Qe;++a,s<<=1)for(let l=0;l<256;++l){if(i(l)!==a)continue;let c=0;for(let u=0;u<a;++u)c|=(s>>u&1)<<a-1-u;n(r,l,c,a),++s}for(let a=0;a<256;++a)i(a)===Gt&&n(r,a,0,0)}return t}function Yt(o,e,t,n){let r=0,i=0,s=0,a=0;for(let l=0;l<n.length;++l){for(;i<Qe&&s<o.length;)r|=o[s++]<<i,i+=8;let c=e[(a>>t)*ge+(r&ge-1)],u=c>>8;if(u>i)return!1;r>>>=u,i-=u,a=n[l]=c&255}return s===o.length&&r===0}async function qt(o){let e=new Blob([o]).stream().pipeThrough(new DecompressionStream("deflate"));return new Uint8Array(await new Response(e).arrayBuffer())}async function Ht(o,e){let t=Number(o.dtype.slice(2)),n=t*o.shape.reduce((c,u)=>c*u,1),r=t===1?n:o.shape[0],i=n/r/2,s=new Uint8Array(n),a=new Uint16Array(s.buffer,0,n>>1),l=0;for(let c=0;c<o.streams.length;++c){let[,u,h]=o.streams[c],m=Math.ceil(r/Ge),p=await qt(e.subarray(l,l+h));if(p.length!==128*(256>>u))return null;let g=Vt(p,256>>u),v=t===1?s:new Uint8Array(r),d=new DataView(e.buffer,e.byteOffset+l+h,8*m);l+=h+8*m;for(let A=0;A<m;++A){let b=l+d.getUint32(8*A,!0),x=v.subarray(A*Ge,Math.min((A+1)*Ge,r));if(b>e.length||!Yt(e.subarray(l,b),g,u,x))return null;l=b}if(t>1)for(let A=0,b=c>>1;A<r;++A,b+=i)a[b]|=v[A]<<8*(c&1)}for(let c=0;t>1&&c<i;++c)if(o.streams[2*c][0])for(let u=1,h=i+c;u<r;++u,h+=i)a[h]+=a[h-i];return nt(o.dtype,s.buffer)??s}async function at(o){for(let[e,t]of Object.entries(o.header.packed??{})){let n=await Ht(t,o.arrays.get(e)?.data).catch(()=>null);if(!n)throw new T(`The member ${e} of the file is damaged. Copy or make the file again.`);o.arrays.set(e,{shape:t.shape,data:n})}return o}var J={blocks:{ClipPlanes:{bytes:400,fields:{clip_brushes:256,clip_plane_count:384,clip_planes:0,clip_rounding:388,clip_tilts:128}},Coding:{bytes:96,fields:{anchor_scale:0,end_vector_scale:28,lattice_edge:24,radius_scale:12,rotation_scales:32,step_low:16,step_span:20}},Frame:{bytes:208,fields:{half_line_width:172,line_reach:184,most_pixels_per_mm:192,plane_rounding:188,reference:160,segment_deviation:200,segment_size:204,view_planes:64,viewport:176,w_per_mm:196,window_from_local:0}},Rays:{bytes:5632,fields:{rays_centres:3072,rays_first_layers:4096,rays_first_tallies:5120,rays_layer_counts:4608,rays_rectangles:3584,rays_rows:0}},Rotations:{bytes:16384,fields:{rotations:0}}},fields:{anchor_x:[0,0,16],anchor_y:[0,16,16],anchor_z:[1,0,16],begin:[1,30,1],cap:[2,26,4],code:[1,0,22],end:[1,31,1],kind:[2,30,2],last:[2,20,6],point:[2,0,20],rank:[1,16,14],shape:[0,0,32],step:[1,22,10]},lines:`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define FEATURE_ANCHORS_LOW 1
#define FEATURE_LATTICE 1
#define FEATURE_SPLINE 1
#define FEATURE_WIDE_LATTICE 1
uint AD(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))-1u);
}
int AD(int value,int offset,int bits){
return bits==32?value:(value<<(32-offset-bits))>>(32-bits);
const uint Cd=14u;
const float AU=32767.0;
const float DK=1023.0;
const uint DL=20u;
const uint Ce=12u;
const uint DH=6u;
const int Cc=7;
const int DI=10;
const int DJ=3;
const uint A8=5u;
const uint DG=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_WIDE=3u;
uint Dg(uvec2 words){return AD(words.x,0,16);}
uint Dh(uvec2 words){return AD(words.x,16,16);}
uint Di(uvec2 words){return AD(words.y,0,16);}
uint Dn(uvec2 words){return AD(words.y,16,14);}
uint Dj(uvec2 words){return AD(words.y,30,1);}
uint Dl(uvec2 words){return AD(words.y,31,1);}
uint Ba(uvec3 words){return AD(words.x,0,32);}
uint Dk(uvec3 words){return AD(words.y,0,22);}
uint Bb(uvec3 words){return AD(words.y,22,10);}
uint Bw(uvec3 words){return AD(words.z,20,6);}
uint BE(uvec3 words){return AD(words.z,26,4);}
uint BF(uvec3 words){return AD(words.z,30,2);}
ivec3 Dm(uint word){return ivec3(AD(int(word),0,10),AD(int(word),10,10),AD(int(word),20,10));}
layout(std140)uniform Frame{
mat4 window_from_local;
vec4 CX[6];
uvec3 reference;
float half_line_width;
vec2 viewport;
float B3;
float CH;
float B6;
float CY;
float CN;
float CO;
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
ivec2 AF(uint index){return ivec2(int(index&((1u<<uint(ROW_BITS))-1u)),int(index>>uint(ROW_BITS)));}
const uint DX=0u,EG=0u;
uniform highp usampler2D anchor_texels;
uniform highp usampler2D page_texels;
uniform highp usampler2D decoding_texels;
uniform highp usampler2D code_texels;
uniform uint chunk_fiblets;
uvec2 BX(uint f){return texelFetch(anchor_texels,AF(f),0).xy;}
uvec4 C1(uint row){return texelFetch(page_texels,AF(row),0);}
uint Bt(uint index){return texelFetch(decoding_texels,AF(index),0).x;}
uint Bq(uint index){return texelFetch(code_texels,AF(index),0).x;}
uint D9(uint index){return rotations[index>>2][index&3u];}
uint DV(uint index){return 0u;}
const uint DW=0u;
#if FEATURE_ANCHORS_LOW
uniform highp usampler2D anchor_low_texels;
uint DR(uint index){return texelFetch(anchor_low_texels,AF(index),0).x;}
#endif
uint Bk(uint index){return AD(DR(index>>1),int(index&1u)*16,16);}
float Bu(uint a,uint b){return a>=b?float(a-b):-float(b-a);}
vec3 A0(uint f){
uvec2 words=BX(f);
uvec3 q=uvec3(Dg(words),Dh(words),Di(words));
q=(q<<16u)|uvec3(Bk(3u*f),Bk(3u*f+1u),Bk(3u*f+2u));
vec3 d=vec3(Bu(q.x,reference.x),Bu(q.y,reference.y),Bu(q.z,reference.z));
#else
vec3 d=vec3(ivec3(q)-ivec3(reference));
vec3 p=d*anchor_scale;
return p;
bool AV(uint f){return Dj(BX(f))!=0u;}
bool ends(uint f){return Dl(BX(f))!=0u;}
uint D2(uint f){return C1(f>>Cd).x+Dn(BX(f));}
uvec3 Cr(uint f){
uint at=DG*f;
return uvec3(Bt(at),Bt(at+1u),Bt(at+2u));
uint Bx(uint f,uvec3 words){return C1(f>>Cd).y+Dk(words);}
uint Db(uint byte){return AD(Bq(byte>>2),int(byte&3u)*8,8);}
uint AW(uint byte){
uint word=byte>>2,shift=(byte&3u)*8u;
uint low=Bq(word);
return shift==0u?low:(low>>shift)|(Bq(word+1u)<<(32u-shift));
float D8(uint AB){return rotation_scales[AB>>2][AB&3u];}
vec4 D7(uint AB,uint code,float scale){
int word=int(D9((AB<<8u)+code));
vec2 t=scale*vec2(AD(word,0,16),AD(word,16,16));
float w=sqrt(1.0-t.x*t.x-t.y*t.y);
return vec4(0.0,t,w);
uint Cp(uvec3 words){
#if FEATURE_SPLINE
if(BF(words)==KIND_WIDE&&(Bb(words)&7u)==A8)return A8;
return BF(words);
float C3(int value){return value<0?-1.0:1.0;}
float C6(uvec3 words){return step_low+float(Bb(words))*(step_span/DK);}
vec4 Cv(uint shape){
int u=AD(int(shape),0,16),v=AD(int(shape),16,16);
bool forward=abs(u)+abs(v)<=int(AU);
vec2 s=vec2(float(u),float(v))/AU;
float x=1.0-abs(s.x)-abs(s.y);
vec3 d=forward?vec3(x,s)
:vec3(x,(1.0-abs(s.y))*C3(u),(1.0-abs(s.x))*C3(v));
d=d/sqrt(dot(d,d));
vec3 h=forward?vec3(1.0+d.x,-d.z,d.y):vec3(1.0-d.x,d.z,-d.y);
h=h/sqrt(dot(h,h));
return forward?vec4(0.0,h.y,h.z,h.x):vec4(h.y,0.0,h.x,-h.z);
vec3 C2(vec4 q){
vec3 d=vec3(1.0-2.0*(q.y*q.y+q.z*q.z),2.0*(q.x*q.y+q.w*q.z),2.0*(q.x*q.z-q.w*q.y));
return d;
vec4 turned(vec4 a,vec4 t){
vec4 q=vec4(a.x*t.w+a.y*t.z-a.z*t.y,a.w*t.y-a.x*t.z+a.y*t.w,
a.w*t.z+a.x*t.y+a.z*t.w,a.w*t.w-a.y*t.y-a.z*t.z);
return q;
struct Az{
vec3 place;
vec3 AQ;
vec3 square;
vec3 cube;
uint n;
uint byte;
vec3 CP(int word,int low,int count){
return vec3(AD(word,low,count),AD(word,low+count,count),
AD(word,low+2*count,count));
void Cz(inout Az s){
int low=int(AW(s.byte)),high=int(AW(s.byte+2u));
s.n=max(uint(low)&63u,1u);
vec3 d=CP(low,6,Cc),e=CP(high,11,Cc);
float share=1.0/float(s.n);
vec3 square=(d-2.0*e)*share*share,cube=2.0*e*share*share*share;
s.square=square;
s.cube=cube;
s.byte+=DH;
Az Ck(uvec3 words,uint byte){
int shape=int(Ba(words));
float scale=exp2(float(2u*(uint(shape)>>30u))-float(DJ));
Az s;
s.place=vec3(0.0);
s.AQ=scale*CP(shape,0,DI);
s.byte=byte;
Cz(s);
return s;
vec3 CQ(Az s,uint m){
float t=float(m);
vec3 p=s.place+t*(s.AQ+t*(s.square+t*s.cube));
void Dt(inout Az s){
float n=float(s.n);
vec3 AQ=s.AQ+n*(2.0*s.square+3.0*n*s.cube);
s.place=CQ(s,s.n);
s.AQ=AQ;
#if FEATURE_LATTICE
void Cx(uvec3 words,inout uint byte,out ivec3 lo,out uvec2 n,out uint width){
lo=ivec3(AD(shape,0,8),AD(shape,8,8),AD(shape,16,8));
n=uvec2((uint(shape)>>24u)+1u,(Bb(words)&255u)+1u);
width=BF(words);
#if FEATURE_WIDE_LATTICE
if(BF(words)==KIND_WIDE&&Bw(words)>0u){
width=Bb(words)&7u;
if(width==0u){
lo=ivec3(0);
width=Ce;
return;
lo=ivec3(AW(byte),AW(byte+4u),AW(byte+8u));
n=uvec2(AW(byte+12u),AW(byte+16u));
byte+=DL;
ivec3 Cy(uint byte,uint width,ivec3 lo,uvec2 n){
if(width==Ce)return lo+ivec3(AW(byte),AW(byte+4u),AW(byte+8u));
uint code=AW(byte)&(0xFFFFFFFFu>>(32u-8u*width));
uint row=code/n.x;
return lo+ivec3(code-row*n.x,row%n.y,row/n.y);
struct DO{
uint last;
uint kind;
uint AB;
float scale;
float step;
uint width;
uvec2 n;
ivec3 lo;
ivec3 k;
uint m;
float path;
DO walk;
Az Bg;
vec3 CZ;
vec3 Be;
vec3 Ax;
vec3 Aw;
vec4 Bf;
void DB(uint f){
uvec3 words=Cr(f);
Be=A0(f);
Ax=Be;
Aw=vec3(0.0);
walk.last=Bw(words);
walk.kind=Cp(words);
walk.byte=Bx(f,words);
walk.AB=BE(words);
walk.scale=D8(walk.AB);
walk.step=C6(words);
Bf=Cv(Ba(words));
if(walk.kind==A8){
walk.step=lattice_edge*exp2(-float(BE(words)));
walk.m=0u;
walk.path=0.0;
CZ=vec3(0.0);
if(walk.last>0u)Bg=Ck(words,walk.byte);
if(walk.kind!=KIND_DIRECTION){
walk.k=ivec3(0);
Cx(words,walk.byte,walk.lo,walk.n,walk.width);
void DC(uint i){
if(walk.m==Bg.n){
Dt(Bg);
walk.m+=1u;
vec3 local=CQ(Bg,walk.m);
Aw=walk.step*(local-CZ);
CZ=local;
Ax=Be+walk.step*local;
walk.path+=length(Aw);
ivec3 Cm=Cy(walk.byte,walk.width,walk.lo,walk.n);
walk.byte+=walk.width;
walk.k+=Cm;
Aw=walk.step*vec3(Cm);
Ax=Be+walk.step*vec3(walk.k);
if(i>1u){
Bf=turned(Bf,D7(walk.AB,Db(walk.byte+i-2u),walk.scale));
Aw=walk.step*C2(Bf);
Ax+=Aw;
vec3 Df(uint f){
uint word=DV(DW+D2(f)-DX);
vec3 v=end_vector_scale*vec3(Dm(word));
return v;
vec3 Do(uint f){
if(Bw(words)==0u)return ends(f)?vec3(0.0):A0(f+1u)-A0(f);
if(Cp(words)==A8){
return lattice_edge*exp2(-float(BE(words)))*CQ(Ck(words,Bx(f,words)),1u);
if(BF(words)!=KIND_DIRECTION){
uint byte=Bx(f,words),width;
Cx(words,byte,lo,n,width);
return lattice_edge*exp2(-float(BE(words)))*vec3(Cy(byte,width,lo,n));
return C6(words)*C2(Cv(Ba(words)));
vec3 Dd(uint f,bool whole){
if(ends(f)||f+1u>=chunk_fiblets)return vec3(0.0);
if(!whole)return Do(f+1u);
return ends(f+1u)?Df(f+1u):A0(f+2u)-A0(f+1u);
uint CE(vec3 d){
float norm=abs(d.x)+abs(d.y)+abs(d.z);
vec2 s=d.yz/norm;
if(d.x<0.0)s=(1.0-abs(s.yx))*vec2(s.x<0.0?-1.0:1.0,s.y<0.0?-1.0:1.0);
ivec2 i=ivec2(round(clamp(s,-1.0,1.0)*AU));
return uint(i.x&0xFFFF)|(uint(i.y)<<16u);
uint CF(vec3 Ac,uint before){
float size=max(abs(Ac.x),max(abs(Ac.y),abs(Ac.z)));
return size>0.0?CE(Ac/size):before;
vec3 CU(vec3 d){
float size=max(abs(d.x),max(abs(d.y),abs(d.z)));
return size>0.0?normalize(d/size):vec3(0.0);
vec3 Ds(vec3 before,vec3 after){
vec3 sum=before+after;
float square=dot(sum,sum);
return square>1e-6?sum*inversesqrt(square):before;
layout(location=0)in uvec2 item;
uniform uint share_size;
flat out uvec4 o0;flat out uvec4 o1;flat out uvec4 o2;flat out uvec4 o3;flat out uvec4 o4;flat out uvec4 o5;
flat out uvec4 o6;flat out uvec4 o7;flat out uvec4 o8;flat out uvec4 o9;flat out uvec4 o10;flat out uvec4 o11;
flat out uvec4 o12;flat out uvec4 o13;flat out uvec4 o14;
uvec4 slots[15];
uvec4 slot(vec3 point,vec3 AA){return uvec4(floatBitsToUint(point),CF(AA,0u));}
void main(){
uint f=item.x,first=item.y*share_size,stop=first+share_size;
bool end=ends(f);
DB(f);
uint last=walk.last;
vec3 point=Ax,next=end||f+1u>=chunk_fiblets?vec3(0.0):A0(f+1u),before=vec3(0.0),AA;
for(uint i=0u;i<=min(last,stop-1u);++i){
vec3 here=point,run;
if(i<last){
DC(i+1u);
run=Aw;
point=Ax;
}else run=end?vec3(0.0):next-here;
vec3 along=CU(run);
AA=i==0u?along:Ds(before,along);
if(i>=first)slots[i-first]=slot(here,AA);
if(along!=vec3(0.0))before=along;
if(last+1u<stop){
vec3 A1=vec3(0.0);
if(end)next=point;
else A1=Dd(f,false);
if(end&&last==0u&&!AV(f)&&f>0u){
DB(f-1u);
for(uint i=1u;i<=walk.last;++i)DC(i);
AA=CU(next-Ax);
if(first==0u)slots[0]=slot(next,AA);
}else if(A1!=vec3(0.0))AA=CU(A1);
for(uint i=max(last+1u,first);i<stop;++i)slots[i-first]=slot(i==last+1u?next:next+A1,AA);
o0=slots[0];o1=slots[1];o2=slots[2];o3=slots[3];o4=slots[4];o5=slots[5];o6=slots[6];o7=slots[7];
o8=slots[8];o9=slots[9];o10=slots[10];o11=slots[11];o12=slots[12];o13=slots[13];o14=slots[14];
gl_Position=vec4(0.0);
out vec4 colour;
void main(){colour=vec4(0.0);}
#define FEATURE_CLIP_PLANES 1
#define FEATURE_GATHER_SLICES 1
#define FEATURE_LINE_ENDS 1
#define FEATURE_POINT_MASK 1
#define FEATURE_STREAMLINE_MASK 1
#define FEATURE_VALUES_COLOUR 1
#define FEATURE_VALUES_STORED 1
#define FEATURE_WIDE_LINES 1
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
vec4 EE(vec3 p){
vec4 c=window_from_local[0]*p.x+window_from_local[1]*p.y+window_from_local[2]*p.z
+window_from_local[3];
return c;
vec3 Bi(vec4 c){
vec3 d=c.xyz+vec3(vec2(half_line_width),0.0)*c.w;
vec3 Bl(vec4 c){
vec3 d=vec3(viewport+half_line_width,1.0)*c.w-c.xyz;
bool Dq(vec4 c){
return all(greaterThanEqual(Bi(c),vec3(0.0)))&&all(greaterThanEqual(Bl(c),vec3(0.0)));
vec4 CT(vec4 c){
float r=1.0/max(c.w,1e-30);
vec4 window=vec4(c.xyz*r,c.w);
return window;
bool Da(vec4 a,vec4 b,out float t0,out float t1){
t0=0.0;
t1=1.0;
vec3 DQ=Bi(a),DP=Bl(a),DT=Bi(b),DS=Bl(b);
for(int side=0;side<6;++side){
int axis=side>>1;
float da=(side&1)==0?DQ[axis]:DP[axis],db=(side&1)==0?DT[axis]:DS[axis];
if(da<0.0&&db<0.0)return false;
float t=da/(da-db);
if(da<0.0)t0=max(t0,t);
else if(db<0.0)t1=min(t1,t);
return t0<=t1;
const vec2 AL=vec2(23.0,23.0)/256.0;
vec2 Ad(vec4 window){
return clamp(window.xy,vec2(0.0),viewport-0.01);
vec2 Ag(vec4 window){return floor(Ad(window));}
#if FEATURE_CLIP_PLANES
layout(std140)uniform ClipPlanes{
vec4 clip_planes[8];
vec2 clip_tilts[8];
float Cn[8];
int clip_plane_count;
float clip_rounding;
float AY(int plane,vec3 p){
float h=dot(clip_planes[plane].xyz,p)+clip_planes[plane].w;
return h;
float DY(vec3 p){
float least=AY(0,p);
for(int plane=1;plane<clip_plane_count;++plane)least=min(least,AY(plane,p));
return least;
bool Co(vec3 a,vec3 b,inout float t0,inout float t1){
for(int plane=0;plane<clip_plane_count;++plane){
float ha=AY(plane,a),hb=AY(plane,b);
if(ha<0.0&&hb<0.0)return false;
float t=ha/(ha-hb);
if(ha<0.0)t0=max(t0,t);
else if(hb<0.0)t1=min(t1,t);
bool C0(vec3 p){return DY(p)>=0.0;}
bool Co(vec3 a,vec3 b,inout float t0,inout float t1){return true;}
bool C0(vec3 p){return true;}
struct AT{
vec3 local;
vec4 clip;
vec4 window;
bool AI;
struct AM{
vec4 a;
vec4 b;
float t0;
float t1;
bool start;
bool AB;
float reach;
bool C7;
AT DA(vec3 p){
vec4 clip=EE(p);
vec4 window=CT(clip);
bool AI=true;
AI=Dq(clip)&&C0(p);
return AT(p,clip,window,AI);
bool Ct(bool end,bool Cw){
#if FEATURE_LINE_ENDS
return end&&!Cw;
return end||Cw;
AM Dc(vec4 a,vec4 b,float t0,float t1,AM whole){
return AM(a,b,t0,t1,Ct(whole.start,t0>0.0),Ct(whole.AB,t1<1.0),0.0,false);
bool DZ(AT from,AT to,inout AM piece){
if(from.AI&&to.AI)return true;
float t0,t1;
if(!Da(from.clip,to.clip,t0,t1))return false;
if(!Co(from.local,to.local,t0,t1))return false;
if(t0>0.0)piece.a=CT(from.clip+t0*(to.clip-from.clip));
if(t1<1.0)piece.b=CT(from.clip+t1*(to.clip-from.clip));
piece=Dc(piece.a,piece.b,t0,t1,piece);
return true;
bool CG(AT from,AT to,bool start,bool AB,out AM piece){
piece=AM(from.window,to.window,0.0,1.0,start,AB,0.0,false);
return DZ(from,to,piece);
bool CG(vec3 from,vec3 to,bool start,bool AB,out AM piece){
return CG(DA(from),DA(to),start,AB,piece);
const float Bh=0.1,BV=0.05;
vec2 Du(vec4 end,vec3 Bj){
vec4 c=window_from_local[0]*Bj.x+window_from_local[1]*Bj.y+window_from_local[2]*Bj.z;
vec2 run=c.xy-end.xy*c.w;
float size=length(run);
return size>Bh*end.w?run/size:vec2(0.0);
vec3 A3(uint word){
ivec2 s=ivec2(int(word<<16)>>16,int(word)>>16);
vec2 p=vec2(s)/AU;
float x=1.0-abs(p.x)-abs(p.y);
if(x<0.0)p=(1.0-abs(p.yx))*vec2(s.x<0?-1.0:1.0,s.y<0?-1.0:1.0);
return normalize(vec3(x,p));
const int FAR_TILE=4;
#ifndef AC
#define AC flat out
AC uvec2 AO;
AC vec3 BL;
AC vec3 BM;
AC vec4 AE;
AC vec4 AH;
AC vec4 Ae;
#if FEATURE_VALUES_COLOUR
AC uvec2 Ar;
#if FEATURE_WIDE_LINES
AC vec2 BJ;
#if FEATURE_GATHER_SLICES
AC uint BK;
const float A9=64.0;
AC vec3 BI;
AC vec3 BN;
const bool SPRITES=false;
layout(location=0)in uvec4 C4;
layout(location=1)in uvec4 C5;
layout(location=2)in uvec4 EB;
uniform int share_size;
uniform highp usampler2D items;
uniform int first_item;
uniform uint layer;
#if FEATURE_STREAMLINE_MASK
uniform highp usampler2D kept;
#if FEATURE_POINT_MASK
uniform highp usampler2D kept_points;
bool Bc(uint point){
uint word=point>>5u;
return((texelFetch(kept_points,AF(word),0).x>>(point&31u))&1u)!=0u;
uniform highp sampler2D point_colours;
vec4 Cq(uint point){return texelFetch(point_colours,AF(point),0);}
#if FEATURE_VALUES_STORED
uniform highp usampler2D value_texels;
uniform highp usampler2D value_table;
float C9(uint point){
return uintBitsToFloat(texelFetch(value_table,AF(texelFetch(value_texels,AF(point),0).x),0).x);
uniform highp usampler2D far_tiles;
bool hidden(AM piece){
vec2 reach=vec2(half_line_width>0.0?half_line_width+1.0:0.0),low=min(piece.a.xy,piece.b.xy)-reach,high=max(piece.a.xy,piece.b.xy)+reach;
ivec2 last=textureSize(far_tiles,0)-1;
ivec2 from=clamp(ivec2(low)/FAR_TILE,ivec2(0),last),to=clamp(ivec2(high)/FAR_TILE,ivec2(0),last);
if(any(greaterThan(to-from,ivec2(1))))return false;
uint farthest=max(max(texelFetch(far_tiles,from,0).x,texelFetch(far_tiles,to,0).x),
max(texelFetch(far_tiles,ivec2(from.x,to.y),0).x,texelFetch(far_tiles,ivec2(to.x,from.y),0).x));
return min(piece.a.z,piece.b.z)-abs(piece.b.z-piece.a.z)>uintBitsToFloat(farthest);
int index=SPRITES?gl_VertexID:gl_InstanceID,place=first_item+index/share_size;
uvec4 item=texelFetch(items,AF(uint(place)),0);
uint points=item.z&63u,share=item.z>>8u;
bool AV=(item.z&64u)!=0u,ends=(item.z&128u)!=0u;
uint k=share*uint(share_size)+uint(index%share_size),count=points-(ends&&points>1u?1u:0u);
gl_Position=vec4(2.0,2.0,2.0,1.0);
gl_PointSize=1.0;
if(k>=count)return;
if(texelFetch(kept,AF(item.x),0).x==0u)return;
bool start=k==0u&&AV,AB=k+1u==count&&ends;
if(!start&&!AB)return;
uint here=item.y+k,there=item.y+min(k+1u,points-(ends?1u:0u));
if(!Bc(here)||!Bc(there))return;
#if !FEATURE_LINE_ENDS
start=start||!Bc(here-1u);
AB=AB||!Bc(there+1u);
vec2 values=vec2(0.0);
values=vec2(C9(here),C9(there));
vec3 from=uintBitsToFloat(C4.xyz),to=uintBitsToFloat(C5.xyz);
AM piece;
if(!CG(from,to,start,AB,piece)||hidden(piece))return;
AO=uvec2(item.x|layer,(piece.start?1u:0u)|(piece.AB?2u:0u));
BL=A3(C4.w);
BM=A3(C5.w);
AE=piece.a;
AH=piece.b;
Ae=vec4(piece.t0,piece.t1,values);
Ar=uvec2(packUnorm4x8(Cq(here)),packUnorm4x8(Cq(there)));
BK=here*uint(A9);
BJ=piece.AB?vec2(0.0):Du(piece.b,uintBitsToFloat(EB.xyz)-to);
BI=mix(from,to,piece.t0);
BN=mix(from,to,piece.t1);
vec2 a=piece.a.xy,run=piece.b.xy-a;
float size=length(run),reach=half_line_width+0.05,back=piece.start?reach:0.05;
back=reach;
vec2 along=size>0.0?run/size:vec2(1.0,0.0),across=vec2(-along.y,along.x);
vec2 at=((gl_VertexID&2)==0?a-back*along:piece.b.xy+reach*along)+((gl_VertexID&1)==0?-reach:reach)*across;
gl_Position=vec4(2.0*at/viewport-1.0,0.0,1.0);
vec2 p=Ag(piece.a)+0.5+AL,q=Ag(piece.b)+0.5+AL,run=q-p;
float square=dot(run,run),size=sqrt(square);
if(size==0.0&&!piece.AB)return;
if(SPRITES){
float pixels=max(abs(run.x),abs(run.y))+(piece.AB?1.0:0.0);
gl_PointSize=pixels;
gl_Position=vec4(2.0*(p-AL+0.5*(pixels-1.0)*sign(run+1e-3))/viewport-1.0,0.0,1.0);
const float reach=0.75;
vec2 at=((gl_VertexID&2)==0?p-reach*along:q+reach*along)+((gl_VertexID&1)==0?-reach:reach)*across;
float depth=square>0.0?piece.a.z+dot(at-p,run)/square*(piece.b.z-piece.a.z):piece.b.z;
gl_Position=vec4(2.0*at/viewport-1.0,2.0*clamp(depth,0.0,0.99999988)-1.0,1.0);
#define FEATURE_CLIP_REGION 1
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
struct Ai{
ivec2 first;
vec2 run;
int count;
float shift;
float inverse;
float square;
Ai Bp(ivec2 p,ivec2 q){
ivec2 run=q-p,size=abs(run);
int n=max(size.x,size.y);
bool AX=size.y>size.x;
float shift=AX?(run.y<0?-AL.y:AL.y):(run.x<0?-AL.x:AL.x);
vec2 way=vec2(run);
return Ai(p,way,n,shift,1.0/float(max(n,1)),1.0/max(dot(way,way),1.0));
float Br(float s,vec2 w){
return clamp(s*w.x/max((1.0-s)*w.y+s*w.x,1e-30),0.0,1.0);
float BA(AT from,AT to,AM piece,float s){
return mix(piece.t0,piece.t1,Br(s,vec2(piece.a.w,piece.b.w)));
const float Aj=448.0;
const float A6=2.0;
const float Al=32.0;
uint BH(vec2 n,float e,float w,uint end){
vec2 q=n/max(abs(n.x)+abs(n.y),1e-30);
int turn=int((q.y>=0.0?1.0-q.x:3.0+q.x)*512.0+0.5)&2047;
int AI=int(clamp((e+A6)*Aj+0.5,0.0,2047.0));
int across=int(clamp(w*Al+0.5,1.0,127.0));
return uint(turn|(AI<<11)|(across<<22))|(end<<29u);
uint BC(vec2 centre,vec2 run,float r){
vec2 away=centre-clamp(dot(centre,run)/max(dot(run,run),1e-12),0.0,1.0)*run;
float size=length(away);
vec2 n=size>1e-4?away/size:vec2(-run.y,run.x)/max(length(run),1e-6);
return BH(n,r-size,2.0*r,0u);
#if !FEATURE_WIDE_LINES
uint CS(ivec2 first,ivec2 last,vec2 at,vec4 parts,bool start,bool AB){
vec2 run=vec2(last-first),a=parts.xy-0.5-at,d=run+parts.zw-parts.xy;
float square=dot(d,d),BO=inversesqrt(max(square,1e-6));
vec2 along=square>1e-6?d:vec2(1.0,0.0);
float left=(along.y*a.x-along.x*a.y)*BO;
bool turned=left<0.0,AV=start&&at==vec2(0.0),ends=AB&&at==run;
float stop=dot(along,AV?a:a+d)*BO;
uint BR=uint(int(2.5+clamp(turned?3.0*stop:-3.0*stop,-1.0,1.0)));
uint end=AV&&ends?7u:AV||ends?(turned==ends?BR:BR+3u):0u;
return BH(turned?vec2(along.y,-along.x):vec2(-along.y,along.x),0.5-abs(left),1.0,end);
bool Bm(vec2 CA,vec2 away){return dot(CA,away)>BV;}
struct Ch{vec3 start;vec3 end;};
vec3 EC(Ch ends,float t){
vec3 d=mix(ends.start,ends.end,t);
return dot(d,d)>1e-6?d:ends.start;
bool AR(float value){return(floatBitsToUint(value)&0x7FFFFFFFu)>0x7F800000u;}
#if FEATURE_CLIP_REGION
layout(std140)uniform Rays{
vec4 rays_rows[192];
vec3 rays_centres[32];
ivec4 D6[32];
int D3[32];
int D5[32];
int D4[32];
const vec2 Ak=vec2(3.0,-3.0);
const float AJ=3.0;
float Aq(float z){return clamp(z,-AJ,AJ);}
vec2 CI(int AG,int planes,vec2 pixel){
vec3 centre=rays_centres[AG];
vec2 d=pixel-centre.xy,span=vec2(-AJ,AJ);
for(int k=0;k<planes;++k){
vec4 row=rays_rows[6*AG+k];
float height=dot(row.xy,d)+row.w;
if(row.z==0.0){
if(height<0.0)return Ak;
continue;
float z=Aq(centre.z-height/row.z);
if(row.z>0.0)span.x=max(span.x,z);
else span.y=min(span.y,z);
return span.x<=span.y?span:Ak;
vec2 CJ(int AG,vec2 pixel){
vec2 d=pixel-centre.xy;
vec4 xy=rays_rows[6*AG],AQ=rays_rows[6*AG+1],along=rays_rows[6*AG+2];
float a=along.x,b=along.y+AQ.z*d.x+AQ.w*d.y;
float c=xy.w+d.x*(AQ.x+xy.x*d.x+xy.z*d.y)+d.y*(AQ.y+xy.y*d.y);
float BD=b*b-a*c;
if(!(BD>=0.0))return a<0.0?vec2(-AJ,AJ):Ak;
float q=-(b+(b<0.0?-1.0:1.0)*sqrt(BD));
float one=q==0.0?0.0:c/q,other=a==0.0?(b<0.0?AJ:-AJ):q/a;
one=Aq(centre.z+one);
other=Aq(centre.z+other);
return vec2(a<0.0?-AJ:min(one,other),a<0.0?min(one,other):max(one,other));
bool along(vec2 span,float z){return span.x<=z&&z<span.y;}
bool planes_hold(int AG,int planes,float z){return along(CI(AG,planes,gl_FragCoord.xy),z);}
bool sphere_holds(int AG,float z){return along(CJ(AG,gl_FragCoord.xy),z);}
#define REGION planes_hold(0, 6, z) || sphere_holds(1, z)
bool CL(float z){return REGION;}
#define AC flat in
uniform vec2 shown_values;
float CV(float t){
vec2 ends=Ae.zw;
if(AR(ends.x)||AR(ends.y))return t<0.5?ends.x:ends.y;
return mix(ends.x,ends.y,t);
float BA(float s){
if(!CL(clamp(mix(AE.z,AH.z,s),0.0,0.99999988)))discard;
float ratio=AE.w/max(AH.w,1e-30);
return mix(Ae.x,Ae.y,clamp(s*ratio/max(1.0-s+s*ratio,1e-30),0.0,1.0));
uint Bn(float t){
uint bits=0u;
float value=CV(t);
if(shown_values.x<=shown_values.y&&!(value>=shown_values.x&&value<=shown_values.y))discard;
bits=floatBitsToUint(value);
bits=packUnorm4x8(mix(unpackUnorm4x8(Ar.x),unpackUnorm4x8(Ar.y),t));
return bits;
layout(location=0)out uvec4 D0;
#if (FEATURE_WIDE_LINES && FEATURE_GATHER_SLICES)
layout(location=1)out uint Dv;
void write(float s,uint edges,float z){
float t=BA(s);
D0=uvec4(AO.x,CF(EC(Ch(BL,BM),t),0u),edges,Bn(t));
Dv=BK+uint(t*A9);
float Bv(AM piece,vec2 centre,vec2 run,float r){
bool first=piece.start&&dot(centre,centre)<=r*r,last=piece.AB&&dot(centre-run,centre-run)<=r*r;
if(first&&!(last&&piece.b.z<piece.a.z))return 0.0;
return last?1.0:-1.0;
bool Bo(float s,vec2 away){
vec2 B0=vec2(AY(plane,BI),AY(plane,BN));
vec2 h=max(B0/max(vec2(AE.w,AH.w),vec2(1e-30)),vec2(0.0));
if(h.x+s*(h.y-h.x)+dot(clip_tilts[plane],away)<0.0)return false;
vec2 run=AH.xy-AE.xy,centre=gl_FragCoord.xy-AE.xy;
bool start=(AO.y&1u)!=0u,AB=(AO.y&2u)!=0u;
float s=Bv(AM(AE,AH,0.0,1.0,start,AB,0.0,false),centre,run,half_line_width);
if(s<0.0)discard;
vec2 away=centre-s*run;
float Ao=dot(centre,run)/max(dot(run,run),1e-12),s=clamp(Ao,0.0,1.0);
if(Ao<0.0&&(AO.y&1u)==0u||dot(away,away)>half_line_width*half_line_width)discard;
if(Ao>1.0&&Bm(BJ,centre-run))discard;
if(!Bo(s,away))discard;
gl_FragDepth=clamp(AE.z+(AH.z-AE.z)*s,0.0,0.99999988);
write(s,BC(away,vec2(0.0),half_line_width),gl_FragDepth);
write(s,BC(centre,run,half_line_width),gl_FragDepth);
vec2 first=Ag(AE),run=Ag(AH)-first,at=floor(gl_FragCoord.xy)-first;
Ai Ab=Bp(ivec2(first),ivec2(first+run));
bool start=(AO.y&1u)!=0u,AB=(AO.y&2u)!=0u,AX=abs(run.y)>abs(run.x);
float s=1.0;
if(at==run){
if(!AB)discard;
}else{
float BG=AX?at.y:at.x,way=AX?run.y:run.x,BQ=abs(BG);
if(BG*way<0.0||BQ>=float(Ab.count))discard;
vec2 line=floor(0.5+AL+(BQ-Ab.shift)*Ab.inverse*run);
if(AX?line.x!=at.x:line.y!=at.y)discard;
s=dot(at-AL,run)*Ab.square;
float z=gl_FragCoord.z;
if(SPRITES)gl_FragDepth=z=clamp(mix(AE.z,AH.z,s),0.0,0.99999988);
vec4 ends=vec4(Ad(AE),Ad(AH)),parts=floor((ends-floor(ends))*256.0)/256.0;
write(s,CS(ivec2(first),ivec2(first+run),at,parts,start,AB),z);
#define FEATURE_COLOUR_ORIENTATION 1
#define FEATURE_COLOUR_POINT_PACKED 1
#define FEATURE_COLOUR_POINT_SCALAR 1
#define FEATURE_COLOUR_SOLID 1
#define FEATURE_COLOUR_STREAMLINE_RGBA 1
#define FEATURE_TABLE_LOGARITHM 1
vec4 Aa(sampler2D colours,uint n){
uint row=uint(textureSize(colours,0).x);
return texelFetch(colours,ivec2(int(n%row),int(n/row)),0);
#if FEATURE_COLOUR_ORIENTATION
vec4 AN(uint streamline,vec3 AA,float value){return vec4(abs(AA),1.0);}
#if FEATURE_COLOUR_SOLID
uniform vec3 colour_solid;
vec4 AN(uint streamline,vec3 AA,float value){return vec4(colour_solid,1.0);}
#if FEATURE_COLOUR_STREAMLINE_RGBA
uniform sampler2D colour_list;
vec4 AN(uint streamline,vec3 AA,float value){return Aa(colour_list,streamline);}
#if FEATURE_COLOUR_POINT_SCALAR
#if FEATURE_TABLE_LOGARITHM
uniform float colour_reference;
float Ap(float value){
float share=colour_reference>0.0?value/colour_reference:-1.0;
float ratio=colour_reference>0.0?1.0+share:value+colour_reference;
return abs(share)<0.01
?share*(1.0-share*(0.5-share*(0.33333333-0.25*share)))*0.4342944819032518
:ratio>0.0?log(ratio)*0.4342944819032518:-3.0e38;
uniform sampler2D colour_table;
uniform int colour_entries;
uniform vec3 colour_range;
uint Av(float value){
uint n=uint(colour_entries);
if(AR(value))return n+2u;
value=Ap(value);
if(value<colour_range.x)return n;
if(value>colour_range.y)return n+1u;
return uint(min((value-colour_range.x)*colour_range.z,float(colour_entries-1)));
vec4 Au(float value){return Aa(colour_table,Av(value));}
vec4 AN(uint streamline,vec3 AA,float value){return Au(value);}
#if FEATURE_COLOUR_POINT_PACKED
vec4 BT(float value){return unpackUnorm4x8(floatBitsToUint(value));}
vec4 AN(uint streamline,vec3 AA,float value){return BT(value);}
uniform highp usampler2D opacities;
uniform int by_streamline;
uniform int by_point;
float CB(uint streamline,float value){
float a=1.0;
if(by_streamline==1)a=float(texelFetch(opacities,AF(streamline),0).r)/255.0;
if(by_point==1)a*=AR(value)?0.0:clamp(value,0.0,1.0);
return a;
uniform float paint_opacity;
uniform float paint_unit;
const float MOST_OPAQUE=0.999;
float EF(float a,uint streamline,float value){
a*=CB(streamline,value);
return floor(0.5-paint_unit*log(1.0-min(paint_opacity*a,MOST_OPAQUE)));
const float A7=0.8;
float Am(vec3 AA,vec3 d){
float along=dot(AA,d);
along*=along;
return max(0.0,1.0-along*along);
float gentle_light(float share){return mix(A7,1.0,share);}
uniform vec3 paint_light;
vec4 D1(uint streamline,vec3 AA,float value){
vec4 c=AN(streamline,AA,value);
float w=1.0;
c.rgb*=gentle_light(Am(AA,paint_light));
w=EF(c.a,streamline,value);
return vec4(floor(255.0*c.rgb+0.5)*w,w);
uniform highp usampler2D texels;
uniform highp sampler2D depths;
uniform vec4 slice_distances;
uniform float slice_far;
uniform vec3 slice_edges;
uniform float sum_unit;
uniform highp usampler2D places;
const float DN=2.0;
layout(location=0)out vec4 Dw;
layout(location=1)out vec4 Dx;
layout(location=2)out vec4 Dy;
layout(location=3)out vec4 Dz;
float Cs(float z){
float c=1.0-z;
return(slice_distances.x+slice_distances.y*c)/(slice_distances.z+slice_distances.w*c);
ivec2 pixel=ivec2(gl_FragCoord.xy);
uint streamline=AO.x&0x0FFFFFFFu;
float first=texelFetch(depths,pixel,0).r,t=BA(s);
bool same=(texelFetch(texels,pixel,0).x&0x0FFFFFFFu)==streamline;
if(s>=1.0&&(AO.y&2u)==0u||s<=0.0&&(AO.y&1u)==0u)discard;
if(same){
float from=float(int(BK-texelFetch(places,pixel,0).x))/A9;
float reach=0.0;
float reach=2.0*DN*half_line_width/max(length(AH.xy-AE.xy),1e-3);
if(max(from,-1.0-from)<=reach)discard;
if(same&&abs(z-first)<4e-7)discard;
float near=Cs(first),far=max(slice_far,near),d=Cs(z);
int slice=int(dot(vec3(greaterThanEqual(vec3(d-near),(far-near)*slice_edges)),vec3(1.0)));
vec3 AA=normalize(BL+BM+1e-6);
vec4 adds=sum_unit*D1(streamline,AA,uintBitsToFloat(Bn(t)));
Dw=slice==0?adds:vec4(0.0);
Dx=slice==1?adds:vec4(0.0);
Dy=slice==2?adds:vec4(0.0);
Dz=slice==3?adds:vec4(0.0);
void main(){gl_Position=vec4(gl_VertexID==1?3.0:-1.0,gl_VertexID==2?3.0:-1.0,0.0,1.0);}
const int TILE=16;
uniform int first;
layout(location=0)out uint some;
ivec2 size=textureSize(texels,0),from=max(ivec2(gl_FragCoord.xy)*TILE-1,ivec2(0));
ivec2 stop=min(ivec2(gl_FragCoord.xy)*TILE+TILE+1,size);
some=0u;
for(int y=from.y;y<stop.y&&some==0u;++y)
for(int x=from.x;x<stop.x;++x){
uvec4 AF=texelFetch(texels,ivec2(x,y),0);
some|=~(AF.x&AF.y);
some=min(some,1u);
if(first+int(some)==0)discard;
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
const int Af=8;
const vec3 SHOULDER=vec3(-0.57735027,0.57735027,0.57735027);
uniform int light_count;
uniform vec3 light_colour[Af];
uniform vec4 light_place[Af];
uniform vec3 light_sum;
uniform float light_standing;
vec3 BS(int i,vec3 place){return normalize(light_place[i].xyz-light_place[i].w*place);}
vec3 B2(vec3 own,vec3 AA,vec3 place,bool illuminated,vec4 reflects,vec3 sheen){
vec3 sight=normalize(-place),AK=sight-AA*dot(AA,sight);
AK=length(AK)>1e-3?normalize(AK):sight;
vec3 AZ=vec3(0.0),Ah=vec3(0.0);
for(int i=0;i<light_count;++i){
vec3 l=BS(i,place);
float along=dot(AA,l),BP=sqrt(max(0.0,1.0-along*along));
AZ+=light_colour[i]*(illuminated?BP:Am(AA,l));
if(reflects.z>0.0){
float CR=illuminated?BP:sqrt(max(0.0,1.0-along*along));
vec3 back=-along*AA+CR*AK;
Ah+=light_colour[i]*pow(max(1e-5,dot(back,sight)),reflects.w);
vec3 on;
if(illuminated)on=AZ/max(1.0,max(light_sum.r,max(light_sum.g,light_sum.b)));
else{
float share=min(dot(AZ,vec3(1.0))/max(dot(light_sum,vec3(1.0)),1e-6),1.0);
on=vec3(gentle_light(light_standing>0.0?share:Am(AA,SHOULDER)));
return reflects.x*own+reflects.y*on*own+reflects.z*sheen*Ah;
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
uvec4 B8(ivec2 pixel){
uvec4 word=texelFetch(texels,pixel,0);
if(word.y==0xFFFFFFFFu&&word.x==0xFFFFFFFFu||(word.x&0xF0000000u)!=layer)discard;
return word;
vec3 A2(ivec2 pixel,vec3 own,vec3 AA){
if(light==0)return own;
vec2 B7=2.0*(vec2(pixel)+0.5)/picture-1.0;
vec4 place=pixel_to_view*vec4(B7,2.0*texelFetch(depths,pixel,0).r-1.0,1.0);
return B2(own,AA,place.xyz/place.w,light==2,reflects,sheen);
vec4 B4(ivec2 pixel,uvec4 word){
uint streamline=word.x&0x0FFFFFFFu;
vec3 AA=A3(word.y);
vec4 own=AN(streamline,AA,uintBitsToFloat(word.w));
if(chosen_colour.a+faded.a>0.0){
uint B1=texelFetch(chosen,AF(streamline),0).r;
vec4 mark=B1!=0u?chosen_colour:faded;
own.rgb=mix(own.rgb,mark.rgb,mark.a);
own.rgb=A2(pixel,own.rgb,normalize(data_to_view*AA));
if(streamline==marked)own.rgb=mix(own.rgb,vec3(1.0,0.9,0.2),0.75);
return own;
layout(location=0)out vec4 colour;
colour=B4(pixel,B8(pixel));
if(colour.a==0.0)discard;
colour.a=1.0;
uniform highp sampler2D sums0;
uniform highp sampler2D sums1;
uniform highp sampler2D sums2;
uniform highp sampler2D sums3;
uniform float opacity;
uniform float absorbance;
uniform float least;
layout(location=1)out vec4 weight;
vec3 seen;
float CM,Bd;
void add(ivec2 pixel,highp sampler2D sums){
vec4 sum=texelFetch(sums,pixel,0);
if(sum.a<least)return;
float through=exp(-absorbance*sum.a),share=Bd*(1.0-through);
seen+=share*A2(pixel,mix(sum.rgb/(255.0*sum.a),faded.rgb,faded.a),vec3(0.70710678,0.70710678,0.0));
CM+=share;
Bd*=through;
uvec4 word=B8(pixel);
vec4 line=B4(pixel,word);
float a=opacity*line.a*CB(word.x&0x0FFFFFFFu,uintBitsToFloat(word.w));
seen=a*line.rgb;
CM=a;
Bd=1.0-a;
add(pixel,sums0);
add(pixel,sums1);
add(pixel,sums2);
add(pixel,sums3);
float alpha=1.0-Bd;
if(alpha<=0.0)discard;
colour=vec4(seen/alpha,alpha);
weight=vec4(CM/alpha,0.0,0.0,alpha);
uniform highp sampler2D mixed;
uniform highp sampler2D weights;
vec4 sum=texelFetch(mixed,pixel,0);
if(sum.a>=1.0)discard;
colour=vec4(sum.rgb/max(texelFetch(weights,pixel,0).r,0.01),1.0-sum.a);
uniform highp sampler2D drawn;
uniform float narrower;
layout(location=0)out uvec4 shown;
uint ED(uint word){
uint AI=(word>>11u)&2047u,width=(word>>22u)&127u;
AI-=min(AI,uint(0.5*narrower*Aj+0.5));
width-=min(width-1u,uint(narrower*Al+0.5));
return(word&0xE00007FFu)|(AI<<11u)|(width<<22u);
ivec2 pixel=ivec2(gl_FragCoord.xy)-1;
shown=uvec4(0u);
if(any(lessThan(pixel,ivec2(0)))||any(greaterThanEqual(pixel,textureSize(texels,0))))return;
uvec4 AF=texelFetch(texels,pixel,0);
bool line=AF.x!=0xFFFFFFFFu||AF.y!=0xFFFFFFFFu;
if(!line&&first==0)discard;
shown=uvec4(floatBitsToUint(texelFetch(depths,pixel,0).r),line?ED(AF.z):0u,packUnorm4x8(texelFetch(drawn,pixel,0)),0u);
struct Edges{
vec2 n;
float e;
float w;
uint end;
float stop;
Edges C8(uint word){
float turn=float(int(word&2047u))/512.0,x=abs(turn-2.0)-1.0;
int width=int((word>>22u)&127u),end=int(word>>29u);
return Edges(normalize(vec2(x,turn<2.0?1.0-abs(x):abs(x)-1.0)),
float(int((word>>11u)&2047u))/Aj-A6,width==127?128.0:float(width)/Al,
uint(end),float(end>3?end-5:end-2)/3.0);
uniform usampler2D shown;
uniform ivec2 shift;
const vec4 X0=vec4(1.5,2.5,5.5,6.5),X1=vec4(-2.5,-1.5,-5.5,-7.5);
const vec4 Y0=vec4(1.5,5.5,3.5,7.5),Y1=vec4(2.5,6.5,4.5,0.5);
const vec4 X2=vec4(4.5,3.5,0.5,7.5),X3=vec4(-0.5,-4.5,-3.5,-6.5);
const vec4 Y2=vec4(-0.5,-4.5,-6.5,-3.5),Y3=vec4(-2.5,-1.5,-5.5,-7.5);
const uint Cb=0x01010101u,Ay=12u,Cg=16u*Ay;
const int AP=4;
struct A5{
float away;
float size;
uint bits(bvec4 AI){
return(AI.x?1u:0u)|(AI.y?0x100u:0u)|(AI.z?0x10000u:0u)|(AI.w?0x1000000u:0u);
uint count(uint EA){return(EA*Cb)>>24u;}
A5 DU(Edges edges,vec2 at,bool there){
float along=edges.n.x*at.y-edges.n.y*at.x;
bool A1=edges.end==7u||edges.end!=0u&&(edges.end<4u)==(along>edges.stop);
return A5(edges.n/16.0,dot(edges.n,at)-edges.e+0.5*edges.w,there&&!A1?0.5*edges.w:-1.0);
uint BZ(A5 BY,vec4 x,vec4 y){
return bits(lessThanEqual(abs(BY.n.x*x+BY.n.y*y+BY.away),vec4(BY.size)));
uint within(Edges edges,vec4 x,vec4 y){
vec4 along=(edges.n.x*y-edges.n.y*x)/16.0;
vec2 range=edges.end==7u?vec2(-0.5,0.5)
:vec2(edges.end<4u?-1.0:edges.stop,edges.end>0u&&edges.end<4u?edges.stop:1.0);
return bits(lessThanEqual(abs(along-0.5*(range.x+range.y)),vec4(0.5*(range.y-range.x))));
uvec4 around[9];
A5 AS[9];
uint visible[9];
uint shares[9];
uint behind[9];
uint lines[9];
#define Cf(what) what(0, -1, -1) what(1, 0, -1) what(2, 1, -1) what(3, -1, 0) what(4, 0, 0) what(5, 1, 0) what(6, -1, 1) what(7, 0, 1) what(8, 1, 1)
#define Ca(what) what(0, -1, -1) what(1, 0, -1) what(2, 1, -1) what(3, -1, 0) what(5, 1, 0) what(6, -1, 1) what(7, 0, 1) what(8, 1, 1)
#define DF(k, right, up) around[k] = texelFetch(shown, pixel + ivec2(right, up), 0);
#define DE(k, right, up) AS[k] = DU(C8(around[k].y), -vec2(right, up), around[k].y != 0u && (line || around[k].x < around[AP].x)); behind[k] = line && around[k].y == 0u && around[k].x > around[AP].x ? 1u : 0u; if (line && abs(AS[k].away) <= AS[k].size) around[k].x = max(around[k].x, around[AP].x); lines[k] = line && around[k].y != 0u ? 1u : 0u; visible[k] = shares[k] = 0u;
#define BW(right, up, a, b, c) { uint m = BZ(AS[AP], right, up) & within(own, right, up), ma = BZ(AS[a], right, up), mb = BZ(AS[b], right, up), mc = BZ(AS[c], right, up), open = Cb & ~((m | ma) | (mb | mc)), left = count(open); bool Ci = around[a].x < depth, Cj = around[b].x < depth, Cl = around[c].x < depth, ab = around[a].x <= around[b].x, ac = around[a].x <= around[c].x, bc = around[b].x <= around[c].x; visible[AP] += m & ~((Ci ? ma : 0u) | (Cj ? mb : 0u) | (Cl ? mc : 0u)); visible[a] += ma & ~((Ci ? 0u : m) | (ab ? 0u : mb) | (ac ? 0u : mc)); visible[b] += mb & ~((Cj ? 0u : m) | (ab ? ma : 0u) | (bc ? 0u : mc)); visible[c] += mc & ~((Cl ? 0u : m) | (ac ? ma : 0u) | (bc ? mb : 0u)); uint BB = behind[a] + behind[b] + behind[c], Dp = lines[a] + lines[b] + lines[c], n = BB > 0u ? BB : Dp; left *= n == 3u ? Ay / 3u : n == 2u ? Ay / 2u : Ay; shares[a] += left * (BB > 0u ? behind[a] : lines[a]); shares[b] += left * (BB > 0u ? behind[b] : lines[b]); shares[c] += left * (BB > 0u ? behind[c] : lines[c]); shares[AP] += n == 0u ? left : 0u; }
#define BU(k) if (abs(AS[k].away) <= AS[k].size && AS[k].size <= 0.5 && around[k].x < depth) { depth = around[k].x; AS[AP] = AS[k]; B9 = around[k].z; }
#define DM(k, right, up) shares[k] += Ay * count(visible[k]);
#define DD(k, right, up) CK += shares[k] * (around[k].z & 0xFF00FFu); Bz += shares[k] * ((around[k].z >> 8u) & 0xFF00FFu);
ivec2 pixel=ivec2(gl_FragCoord.xy)+shift;
Cf(DF)
if(((around[0].y|around[1].y|around[2].y)|(around[3].y|around[4].y|around[5].y)
|(around[6].y|around[7].y|around[8].y))==0u)discard;
Edges own=C8(around[AP].y);
bool line=around[AP].y!=0u;
Ca(DE)
AS[AP]=A5(own.n/16.0,0.5*own.w-own.e,line?0.5*own.w:-1.0);
visible[AP]=shares[AP]=0u;
uint depth=around[AP].x,B9=around[AP].z;
if(!line){BU(1)BU(3)BU(5)BU(7)}
BW(X0,Y0,5,7,8)
BW(X1,Y1,3,7,6)
BW(X2,Y2,5,1,2)
BW(X3,Y3,3,1,0)
Ca(DM)
uint B5=Ay*count(visible[AP]);
if(shares[AP]+(line?B5:0u)==Cg)discard;
uint CK=B5*(B9&0xFF00FFu),Bz=B5*((B9>>8u)&0xFF00FFu);
Cf(DD)
colour=vec4(CK&0xFFFFu,Bz&0xFFFFu,CK>>16u,Bz>>16u)/(255.0*float(Cg));
void main(){colour=vec4(texelFetch(drawn,ivec2(gl_FragCoord.xy),0).rgb,1.0);}
uniform vec3 bottom;
uniform vec3 top;
uniform float height;
void main(){colour=vec4(mix(bottom,top,gl_FragCoord.y/height),1.0);}
layout(location=0)in vec3 place;
layout(location=1)in vec3 AK;
layout(location=2)in vec4 own;
layout(location=3)in float value;
layout(location=4)in float edges;
uniform mat4 clip_from_data;
uniform mat4 view_from_data;
uniform mat3 normal_to_view;
out vec3 A4;
out vec3 CW;
out vec4 CC;
out vec3 Bs;
out float CD;
out vec3 sides;
gl_Position=clip_from_data*vec4(place,1.0);
A4=(view_from_data*vec4(place,1.0)).xyz;
CW=normal_to_view*AK;
CC=own;
Bs=place;
CD=value;
int corner=gl_VertexID%3,shown=int(edges);
sides=max(vec3(corner==0,corner==1,corner==2),vec3((shown&1)==0,(shown&2)==0,(shown&4)==0));
vec3 Dr(vec3 own,vec3 AK,vec3 place,vec4 reflects,vec3 sheen){
vec3 AZ=vec3(0.0),Ah=vec3(0.0),sight=normalize(-place);
float Cu=max(0.0,dot(AK,l));
AZ+=Cu*light_colour[i];
if(reflects.z>0.0&&Cu>0.0)Ah+=light_colour[i]*pow(max(0.0,dot(reflect(-l,AK),sight)),reflects.w);
return reflects.x*own+reflects.y*AZ*own+reflects.z*sheen*Ah;
in vec3 A4;
in vec3 CW;
in vec4 CC;
in vec3 Bs;
in float CD;
in vec3 sides;
uniform int smooth_normals;
uniform int lighting;
uniform int by_value;
uniform float parallel;
uniform float edge_width;
uniform vec4 edge_colour;
uniform int plane_count;
uniform vec4 planes[6];
float De(){
if(edge_width==0.0)return 0.0;
vec3 d=sides/max(sqrt(dFdx(sides)*dFdx(sides)+dFdy(sides)*dFdy(sides)),vec3(1e-9));
return edge_colour.a*clamp(0.5+0.5*edge_width-min(min(d.x,d.y),d.z),0.0,1.0);
float edge=De();
for(int i=0;i<plane_count;++i)if(dot(planes[i].xyz,Bs)+planes[i].w<0.0)discard;
vec3 AK=smooth_normals==1?normalize(CW):normalize(cross(dFdx(A4),dFdy(A4)));
vec3 sight=parallel==1.0?vec3(0.0,0.0,1.0):normalize(-A4);
if(dot(AK,sight)<0.0)AK=-AK;
vec4 own=by_value==1?Au(CD):CC;
own.rgb*=1.0-edge;
vec3 A2=lighting==1?Dr(own.rgb,AK,A4,reflects,sheen):own.rgb;
colour=vec4(A2+edge*edge_colour.rgb,own.a*opacity);
weight=vec4(1.0,0.0,0.0,colour.a);
uniform vec3 corner;
uniform vec3 across;
uniform vec3 up;
out vec2 at;
at=vec2(gl_VertexID&1,gl_VertexID>>1);
gl_Position=clip_from_data*vec4(corner+at.x*across+at.y*up,1.0);
in vec2 at;
uniform highp sampler2D pixels;
uniform int clear;
colour=texture(pixels,at);
if(colour.a<=(clear==0?0.5:0.002))discard;
if(clear==0)colour=vec4(colour.rgb/colour.a,1.0);
colour.a*=opacity;`,page_bits:14,rotation_scales:[39380907423947065e-23,5413425014921813e-22,7445069627465273e-22,1023472805172787e-21,14070004681343562e-22,19338988295203308e-22,2657444838405354e-21,3649580548881204e-21,5006992068956606e-21,6855771061964333e-21,9352394044981338e-21,1266809158551041e-20,1692779733275529e-20,22030990294297226e-21,27206533559365198e-21,300810752378311e-19],rotations:"AAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbRuK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6nLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420biuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07Svlg==",shaders:{"effects/picture/antialias_coverage.frag":[0,5,557,560,927,933,52,53,933,939,11,12,939,941,320,321,941,948,928,929,948,950,52,53,950,952,11,12,952,957,11,12,957,959,11,12,959,964,11,12,964,978,289,290,978,999,11,12],"page/background.frag":[0,5,1e3,1003,872,873,1003,1004],"page/copy.frag":[0,5,912,913,872,873,999,1e3],"page/decode.vert":[0,14,11,12,14,61,52,53,61,63,52,53,63,82,78,79,82,83,81,82,83,87,78,79,87,91,81,82,91,93,11,12,93,99,11,12,99,105,11,12,105,111,11,12,111,114,81,82,114,115,11,12,115,128,11,12,128,131,11,12,131,135,11,12,112,113,135,142,52,53,142,145,11,12,145,154,11,12,154,163,11,12,163,166,92,93,11,12,166,171,161,162,11,12,81,82,171,173,155,156,173,183,11,12,183,186,11,12,81,82,11,12,186,187,176,177,187,188,81,82,188,191,11,12,81,82,191,194,141,142,194,203,52,53,203,204,112,113,204,206,81,82,206,222,112,113,222,228,182,183,11,12,81,82,171,172,228,230,223,224,230,231,11,12,81,82,11,12,231,232,112,113,222,223,232,234,224,225,11,12,234,240,182,183,11,12,81,82,171,172,228,229,240,245,182,183,11,12,81,82,245,247,11,12,247,249,11,12,249,253,11,12,253,254,211,212,254,255,112,113,255,257,11,12,81,82,171,172,257,259,198,200,259,261,11,12,81,82,261,262,11,12,262,266,11,12,266,272,11,12,272,275,11,12,275,278,11,12,278,282,11,12,282,306,11,12,306,317,11,12,317,320,11,12],"page/far_tiles.frag":[0,5,439,440,758,759,804,805,289,290,805,810,11,12],"page/image.frag":[0,5,1066,1068,880,881,1068,1069,872,873,883,884,289,290,1069,1073,1059,1060,11,12],"page/image.vert":[0,5,1009,1010,1060,1064,289,290,1064,1066,11,12],"page/mixed.frag":[0,5,907,909,872,873,289,290,772,773,909,912,11,12],"page/none.frag":[0,5,320,322],"page/resolve.frag":[0,5,689,695,538,539,15,16,433,439,11,12,816,817,744,745,817,818,745,749,11,12,749,750,818,836,11,12,11,12,836,841,11,12,841,842,11,12,695,698,11,12,587,588,63,65,698,700,81,82,700,703,81,82,703,706,81,82,706,715,11,12,81,82,715,721,707,708,721,722,81,82,722,725,11,12,725,727,81,82,727,730,81,82,757,759,464,465,842,856,11,12,856,861,11,12,861,869,11,12,869,872,11,12,872,873,289,290,772,773,873,876,11,12],"page/screen.vert":[0,5,791,792],"page/segment.frag":[0,5,322,323,537,538,323,325,327,333,11,12,538,539,40,53,359,362,11,12,362,363,539,546,52,53,546,553,11,12,363,370,52,53,370,373,11,12,81,82,387,392,52,53,392,401,52,53,553,555,11,12,555,557,11,12,557,566,11,12,450,451,566,571,11,12,81,82,571,582,11,12,81,82,427,428,582,583,15,16,266,272,11,12,272,275,11,12,583,587,11,12,587,596,52,53,596,608,11,12,608,611,11,12,611,612,11,12,612,613,600,601,613,624,11,12,624,629,81,82,629,630,440,442,81,82,442,450,81,82,450,455,81,82,363,364,455,457,81,82,81,82,457,458,474,475,630,635,11,12,81,82,635,636,588,589,636,637,81,82,637,639,11,12,639,641,474,475,641,644,81,82,448,449,644,645,81,82,645,646,11,12,646,649,81,82,649,652,647,648,652,653,81,82,11,12,450,451,408,409,653,657,11,12,81,82,363,364,657,658,378,379,658,661,11,12,421,422,11,12,81,82,289,290,661,662,408,409,662,666,89,90,666,667,665,666,667,669,81,82,363,364,669,670,81,82,670,671,408,409,671,672,89,90,672,673,81,82,11,12,89,90,289,290,673,685,11,12,685,689,11,12,81,82],"page/segment.vert":[0,5,322,333,11,12,40,53,333,337,11,12,337,339,130,131,11,12,339,341,130,131,11,12,341,343,11,12,343,347,11,12,347,358,11,12,358,359,11,12,359,362,11,12,362,370,52,53,370,373,11,12,373,377,11,12,377,384,11,12,358,359,11,12,384,385,89,90,385,387,81,82,387,392,52,53,392,401,52,53,401,407,11,12,407,410,89,90,410,411,81,82,11,12,411,413,11,12,413,422,11,12,422,425,11,12,425,427,11,12,427,433,11,12,15,16,433,439,11,12,439,440,63,65,440,442,81,82,442,450,81,82,450,455,81,82,363,364,455,457,81,82,81,82,457,460,450,451,460,461,81,82,461,467,81,82,467,472,11,12,81,82,448,449,472,474,81,82,474,479,11,12,81,82,479,488,11,12,289,290,488,496,465,466,496,497,81,82,497,498,408,409,498,499,81,82,499,500,467,468,500,504,81,82,81,82,504,505,474,475,505,506,81,82,506,515,448,449,515,516,81,82,450,451,452,453,516,517,81,82,517,518,363,364,518,520,81,82,520,522,408,409,522,523,81,82,523,526,89,90,526,528,523,524,528,533,182,183,11,12,533,537,81,82,11,12],"page/sum.frag":[0,5,322,323,537,538,689,694,323,325,694,695,327,333,11,12,538,539,40,53,359,362,11,12,362,363,539,546,52,53,546,553,11,12,363,370,52,53,370,373,11,12,81,82,387,392,52,53,392,401,52,53,553,555,11,12,555,557,11,12,557,566,11,12,450,451,566,571,11,12,81,82,571,582,11,12,81,82,427,428,582,583,587,596,52,53,596,608,11,12,608,611,11,12,611,612,11,12,612,613,600,601,613,624,11,12,624,629,81,82,629,630,440,442,81,82,442,450,81,82,450,455,81,82,363,364,455,457,81,82,81,82,457,458,474,475,630,635,11,12,81,82,635,636,588,589,636,637,81,82,637,639,11,12,639,641,474,475,641,644,81,82,448,449,644,645,81,82,645,646,11,12,695,698,11,12,698,700,81,82,700,703,81,82,703,706,81,82,706,715,11,12,81,82,715,721,707,708,721,722,81,82,722,725,11,12,725,727,81,82,727,730,81,82,63,65,730,738,11,12,738,744,11,12,744,749,11,12,749,757,11,12,757,763,647,648,763,765,81,82,765,772,11,12,649,650,772,776,450,451,776,777,81,82,647,648,777,779,408,409,779,780,89,90,780,781,81,82,781,782,11,12,89,90,782,783,81,82,783,791,11,12,450,451,408,409,653,657,11,12,81,82,363,364,657,658,378,379,658,661,11,12,421,422,11,12,81,82,289,290,661,662,408,409,662,666,89,90,666,667,665,666,667,669,81,82,363,364,669,670,81,82,670,671,408,409,671,672,89,90,672,673,81,82,11,12,89,90,289,290,673,685,11,12,685,689,11,12,81,82],"page/surface.frag":[0,5,694,695,816,817,818,821,823,824,1026,1028,828,830,1028,1031,11,12,1031,1032,11,12,695,698,11,12,587,588,707,715,11,12,81,82,715,721,707,708,721,722,81,82,722,725,11,12,725,726,1032,1042,880,881,843,845,1042,1046,872,873,883,884,1046,1050,11,12,289,290,1050,1060,11,12],"page/surface.vert":[0,5,1004,1018,289,290,1018,1026,11,12],"page/through.frag":[0,5,689,695,538,539,15,16,433,439,11,12,816,817,744,745,817,818,745,749,11,12,749,750,818,836,11,12,11,12,836,841,11,12,841,842,11,12,695,698,11,12,587,588,63,65,698,700,81,82,700,703,81,82,703,706,81,82,706,715,11,12,81,82,715,721,707,708,721,722,81,82,722,725,11,12,725,727,81,82,727,730,81,82,757,759,464,465,842,856,11,12,856,861,11,12,861,869,11,12,869,872,11,12,730,738,11,12,876,883,872,873,883,893,11,12,289,290,772,773,893,907,11,12],"page/tile_mask.frag":[0,5,792,793,757,758,793,795,289,290,795,802,11,12,802,804,11,12],"page/tiles.vert":[0,5,792,793,810,812,289,290,812,816,11,12],"page/visible_edges.frag":[0,5,330,333,11,12,557,558,559,560,757,759,912,914,793,794,914,920,11,12,289,290,920,927,11,12]}};var Xt=J.lines.split(`
`);function Wt(o){let e=[];for(let t=0;t<o.length;t+=2)e.push(...Xt.slice(o[t],o[t+1]));return e.join(`
`)+`
`}var Ve={};for(let[o,e]of Object.entries(J.shaders))Ve[o]=Wt(e);var ve=J.blocks,lt=J.rotation_scales,ae=J.page_bits;function Y(o){let e=atob(o),t=new Uint8Array(e.length);for(let n=0;n<e.length;++n)t[n]=e.charCodeAt(n);return t}var ct=Y(J.rotations),Jt=J.fields;function P(o,e){let[,t,n]=Jt[o];return n===32?e:e>>>t&(1<<n)-1}var j=(o,e)=>[o[0]-e[0],o[1]-e[1],o[2]-e[2]],q=(o,e,t=1)=>[o[0]+t*e[0],o[1]+t*e[1],o[2]+t*e[2]],Z=(o,e)=>[o[0]*e,o[1]*e,o[2]*e],H=(o,e)=>o[0]*e[0]+o[1]*e[1]+o[2]*e[2],le=(o,e)=>[o[1]*e[2]-o[2]*e[1],o[2]*e[0]-o[0]*e[2],o[0]*e[1]-o[1]*e[0]],qe=o=>Math.hypot(o[0],o[1],o[2]),re=o=>Z(o,1/(qe(o)||1));function R(o,e){let t=new Float64Array(16);for(let n=0;n<4;++n)for(let r=0;r<4;++r){let i=0;for(let s=0;s<4;++s)i+=o[r+4*s]*e[s+4*n];t[r+4*n]=i}return t}function be(){let o=new Float64Array(16);return o[0]=o[5]=o[10]=o[15]=1,o}function K(o){let e=Array.from({length:4},(n,r)=>Array.from({length:8},(i,s)=>s<4?o[r+4*s]:s-4===r?1:0));for(let n=0;n<4;++n){let r=n;for(let s=n+1;s<4;++s)Math.abs(e[s][n])>Math.abs(e[r][n])&&(r=s);if(!(Math.abs(e[r][n])>0))return null;[e[n],e[r]]=[e[r],e[n]];let i=e[n][n];for(let s=0;s<8;++s)e[n][s]/=i;for(let s=0;s<4;++s){if(s===n)continue;let a=e[s][n];for(let l=0;l<8;++l)e[s][l]-=a*e[n][l]}}let t=new Float64Array(16);for(let n=0;n<4;++n)for(let r=0;r<4;++r)t[n+4*r]=e[n][r+4];return t}function L(o,e,t=1){return[0,1,2,3].map(n=>o[n]*e[0]+o[n+4]*e[1]+o[n+8]*e[2]+o[n+12]*t)}function we(o){return[o[0],o[1],o[2],o[4],o[5],o[6],o[8],o[9],o[10]]}var Re=o=>new Float32Array(o);function Ye(o,e,t){let n=t*Math.PI/180,r=Math.cos(n),i=Math.sin(n),s=re(e);return q(q(Z(o,r),le(s,o),i),s,H(s,o)*(1-r))}var jt={position:[0,0,1],focal_point:[0,0,0],up:[0,1,0],view_angle:30,parallel:!1,parallel_scale:1},Ce=class{constructor(e=jt){f(this,"state",e)}get forward(){return re(j(this.state.focal_point,this.state.position))}get right(){return re(le(this.forward,this.state.up))}get distance(){return qe(j(this.state.focal_point,this.state.position))}view(){let e=this.forward,t=this.right,n=le(t,e),r=this.state.position;return new Float64Array([t[0],n[0],-e[0],0,t[1],n[1],-e[1],0,t[2],n[2],-e[2],0,-H(t,r),-H(n,r),H(e,r),1])}range(e){let t=this.forward,n=this.state.position,r=1/0,i=-1/0;for(let a=0;a<8;++a){let l=H(t,j([e[a&1],e[2+(a>>1&1)],e[4+(a>>2)]],n));r=Math.min(r,l),i=Math.max(i,l)}let s=Math.max(.005*(i-r),1e-6*Math.abs(i));return r-=s,i+=s,this.state.parallel?[r,Math.max(i,r+1e-6)]:(i=Math.max(i,1e-6),[Math.max(r,.001*i),i])}projection(e,t){let[n,r]=this.range(t),i=new Float64Array(16),s=this.state;if(s.parallel)i[0]=1/(s.parallel_scale*e),i[5]=1/s.parallel_scale,i[10]=-2/(r-n),i[14]=-(r+n)/(r-n),i[15]=1;else{let a=1/Math.tan(s.view_angle*Math.PI/360);i[0]=a/e,i[5]=a,i[10]=-(r+n)/(r-n),i[11]=-1,i[14]=-2*r*n/(r-n)}return i}rotate(e,t){let n=this.state,r=Ye(j(n.position,n.focal_point),n.up,-200*e),i=re(le(Z(r,-1),n.up));r=Ye(r,i,-200*t),n.position=q(n.focal_point,r),n.up=re(le(i,re(Z(r,-1))))}roll(e){this.state.up=Ye(this.state.up,this.forward,e)}pan(e,t){let n=this.state,r=n.parallel?2*n.parallel_scale:2*this.distance*Math.tan(n.view_angle*Math.PI/360),i=le(this.right,this.forward),s=q(Z(this.right,-e*r),i,-t*r);n.position=q(n.position,s),n.focal_point=q(n.focal_point,s)}dolly(e){let t=this.state;t.parallel?t.parallel_scale/=e:t.position=q(t.focal_point,j(t.position,t.focal_point),1/e)}lookAlong(e,t,n,r){let i=this.state,[s,a]=[0,1].map(m=>[0,1,2].map(p=>n[2*p+m])),l=qe(j(a,s))/2||1,c=Math.min(r,1);i.view_angle=30,i.up=t,i.focal_point=Z(q(s,a),.5),i.position=q(i.focal_point,re(e),-l/Math.sin(Math.atan(Math.tan(Math.PI/12)*c))),i.parallel_scale=l/c;let u=R(this.projection(r,n),this.view()),h=0;for(let m=0;m<27;++m){let p=[m%3,Math.floor(m/3)%3,Math.floor(m/9)];if(p.filter(A=>A===1).length!==1)continue;let[g,v,,d]=L(u,p.map((A,b)=>s[b]+A/2*(a[b]-s[b])));h=Math.max(h,Math.abs(g/d),Math.abs(v/d))}h>0&&h<1/0&&(i.parallel?i.parallel_scale*=h/.92:i.view_angle*=h/.92)}};var De=class{constructor(e,t){f(this,"lines",e);f(this,"base",t);f(this,"ranges",new Map);f(this,"regions",new Map);f(this,"hidden",new Set);f(this,"groups",[]);f(this,"chosen",null)}get count(){let e=this.chosen;return e?e.reduce((t,n)=>t+n,0):this.lines.set.streamlines}set(e,t,n,r){let i=this.ranges.get(e.name)??{values:t,low:e.range[0],high:e.range[1],whole:e.range};n===0?i.low=r:i.high=r,this.ranges.set(e.name,i),this.apply()}look(e,t){let{set:n,model:r}=this.lines,i=t?this.regions.get(e):void 0;this.regions.set(e,{through:n.through(e,r,i?.blocks,i?.through),blocks:n.blocks.length})}apply(){let e=[...this.ranges.values()].filter(s=>s.low>s.whole[0]||s.high<s.whole[1]),t=[...this.regions].filter(([s])=>s.on);if(!e.length&&!t.length&&!this.hidden.size)return this.keep(this.base);let n=this.lines.set.streamlines,r=new Uint8Array(n),i=this.grouped(n);for(let s=0;s<n;++s){let a=this.base===null||this.base[s]!==0;for(let l of e){let c=1e-6*(l.whole[1]-l.whole[0]);a=a&&l.values[s]>=l.low-c&&l.values[s]<=l.high+c}for(let[l,{through:c}]of t)a=a&&c[s]!==0!==l.inverted;r[s]=a&&i[s]?1:0}this.keep(r)}keep(e){this.chosen=e,this.lines.keep(e)}grouped(e){let t=new Uint8Array(e).fill(1);for(let n of this.hidden)for(let r of n)t[r]=0;for(let n of this.hidden.size?this.groups:[])if(!this.hidden.has(n))for(let r of n)t[r]=1;return t}};function ut(o,e,t,n){let r=new Float32Array(7*e);for(let i=0;i<e;++i){let s=4*t*i,a=n(i),l=s+4*(Math.min(a,t)-1),c=7*i,u=o[l]-o[s],h=o[l+1]-o[s+1],m=o[l+2]-o[s+2],p=u*u+h*h+m*m||1,g=0;for(let v=s+4;v<s+4*a;v+=4){let d=o[v]-o[s],A=o[v+1]-o[s+1],b=o[v+2]-o[s+2],x=Math.min(Math.max((d*u+A*h+b*m)/p,0),1),F=d-x*u,w=A-x*h,E=b-x*m;g=Math.max(g,F*F+w*w+E*E)}for(let v=0;v<3;++v)r[c+v]=o[s+v],r[c+3+v]=o[l+v];r[c+6]=1.0001*Math.sqrt(g)+1e-4}return r}function ht(o,e,t,n,r,i,s){let a=Float64Array.from(e),[l,c,u,h]=[0,1,2,3].map(d=>Math.hypot(a[d],a[d+4],a[d+8])),{size:m,columns:p,rows:g,depths:v}=i;for(let d=0,A=0;d<s.length;++d,A+=7){let b=o[A+6],x=1/0,F=-1/0,w=1/0,E=-1/0,B=1/0;for(let O=A;O<A+6;O+=3){let N=o[O],ee=o[O+1],X=o[O+2],se=a[3]*N+a[7]*ee+a[11]*X+a[15],oe=se-b*h;if(!(oe>0)){B=-1/0;break}let W=(a[0]*N+a[4]*ee+a[8]*X+a[12])/se,_=(a[1]*N+a[5]*ee+a[9]*X+a[13])/se,te=b*(l+Math.abs(W)*h)/oe+t,Te=b*(c+Math.abs(_)*h)/oe+t;W-te<x&&(x=W-te),W+te>F&&(F=W+te),_-Te<w&&(w=_-Te),_+Te>E&&(E=_+Te),B=Math.min(B,(a[2]*N+a[6]*ee+a[10]*X+a[14]-b*u)/oe)}if(s[d]=1,B===-1/0)continue;if(F<0||x>n||E<0||w>r){s[d]=0;continue}let C=Math.max(Math.floor(x/m),0),D=Math.min(Math.floor(F/m),p-1),I=Math.max(Math.floor(w/m),0),U=Math.min(Math.floor(E/m),g-1);if((D-C+1)*(U-I+1)>256)continue;B-=1e-6;let S=!0;for(let O=I;O<=U&&S;++O)for(let N=C;N<=D;++N)if(B<=v[4*(O*p+N)]){S=!1;break}S&&(s[d]=0)}}function He({at:o,size:e},t){return[0,1,2].map(n=>(t[n]-o[n])/Math.max(e[n],1e-9))}function ft({ball:o},e,t){let n=j(t,e);if(o){let s=Math.min(1,Math.max(0,-H(e,n)/(H(n,n)||1))),a=[e[0]+s*n[0],e[1]+s*n[1],e[2]+s*n[2]];return H(a,a)<=1}let r=0,i=1;for(let s=0;s<3;++s){if(n[s]===0){if(Math.abs(e[s])>1)return!1;continue}let a=(-1-e[s])/n[s],l=(1-e[s])/n[s];r=Math.max(r,Math.min(a,l)),i=Math.min(i,Math.max(a,l))}return r<=i}function dt({ball:o,at:e,size:t}){let n=(i,s,a)=>[e[0]+i*t[0],e[1]+s*t[1],e[2]+a*t[2]];if(o){let i=Array.from({length:49},(s,a)=>[Math.cos(a*Math.PI/24),Math.sin(a*Math.PI/24)]);return[i.map(([s,a])=>n(s,a,0)),i.map(([s,a])=>n(s,0,a)),i.map(([s,a])=>n(0,s,a))]}let r=i=>[n(-1,-1,i),n(1,-1,i),n(1,1,i),n(-1,1,i),n(-1,-1,i)];return[r(-1),r(1),...[[-1,-1],[1,-1],[1,1],[-1,1]].map(([i,s])=>[n(i,s,-1),n(i,s,1)])]}var Ke=o=>Math.min(4096,o.getParameter(o.MAX_TEXTURE_SIZE)),k=4294967295,ce=class extends Error{};function Zt(o,e,t){let n=Math.log2(Ke(o)),r=Ve[e].replace("ROW_BITS=12",`ROW_BITS=${n}`),i=t.includes("SPRITES")?r.replace("const bool SPRITES=false","const bool SPRITES=true"):r,s=t.find(a=>a.startsWith("REGION "));return(s?i.replace(/#define REGION .*/,`#define ${s}`):i).replace(/#define FEATURE_(\w+) [01]/g,(a,l)=>`#define FEATURE_${l} ${t.includes(l)?1:0}`)}var ue=class{constructor(e,t,n,r=[],i=[]){f(this,"gl",e);f(this,"handle");f(this,"places",new Map);f(this,"units",new Map);this.handle=e.createProgram();let s=[[e.VERTEX_SHADER,t],[e.FRAGMENT_SHADER,n]].map(([a,l])=>{let c=e.createShader(a);return e.shaderSource(c,Zt(e,l,r)),e.compileShader(c),e.attachShader(this.handle,c),[l,c]});if(i.length&&e.transformFeedbackVaryings(this.handle,i,e.INTERLEAVED_ATTRIBS),e.linkProgram(this.handle),!e.getProgramParameter(this.handle,e.LINK_STATUS)&&!e.isContextLost()){let a=s.map(([l,c])=>`${l}: ${e.getShaderInfoLog(c)}`).join("; ");throw new ce(`This browser's graphics cannot run the page's programs: ${e.getProgramInfoLog(this.handle)} ${a}`)}Object.keys(ve).forEach((a,l)=>{let c=e.getUniformBlockIndex(this.handle,a);c!==e.INVALID_INDEX&&e.uniformBlockBinding(this.handle,c,l)})}use(){return this.gl.useProgram(this.handle),this}at(e){return this.places.has(e)||this.places.set(e,this.gl.getUniformLocation(this.handle,e)),this.places.get(e)}set(e){let t=this.gl;for(let[n,r]of Object.entries(e)){let i=this.at(n);i!==null&&(typeof r=="number"?t.uniform1f(i,r):r.length===2?t.uniform2fv(i,r):r.length===3?t.uniform3fv(i,r):r.length===4?t.uniform4fv(i,r):r.length===9?t.uniformMatrix3fv(i,!1,r):t.uniformMatrix4fv(i,!1,r))}return this}ints(e){for(let[t,n]of Object.entries(e)){let r=this.at(t);r!==null&&this.gl.uniform1i(r,n)}return this}uints(e){for(let[t,n]of Object.entries(e)){let r=this.at(t);r!==null&&this.gl.uniform1ui(r,n)}return this}textures(e){let t=this.gl;for(let[n,r]of Object.entries(e)){let i=this.at(n);if(i===null)continue;this.units.has(n)||this.units.set(n,this.units.size);let s=this.units.get(n);t.activeTexture(t.TEXTURE0+s),t.bindTexture(t.TEXTURE_2D,r),t.uniform1i(i,s)}return this}},Xe={r8ui:["R8UI","RED_INTEGER","UNSIGNED_BYTE",1,Uint8Array],r16ui:["R16UI","RED_INTEGER","UNSIGNED_SHORT",1,Uint16Array],r32ui:["R32UI","RED_INTEGER","UNSIGNED_INT",1,Uint32Array],rg32ui:["RG32UI","RG_INTEGER","UNSIGNED_INT",2,Uint32Array],rgba32ui:["RGBA32UI","RGBA_INTEGER","UNSIGNED_INT",4,Uint32Array],rgba8:["RGBA8","RGBA","UNSIGNED_BYTE",4,Uint8Array]};function mt(o){for(let e of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])o.texParameteri(o.TEXTURE_2D,o[e],o.NEAREST);for(let e of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])o.texParameteri(o.TEXTURE_2D,o[e],o.CLAMP_TO_EDGE)}function ye(o,e,t,n){let[r]=Xe[e],i=Ke(o),s=Math.max(1,Math.ceil(t/i)),a=o.getParameter(o.MAX_TEXTURE_SIZE);if(s>a)throw new ce(`The ${n} have ${t} texels; this device's textures hold ${a*i}. Make a page of fewer streamlines.`);let l=o.createTexture();return o.bindTexture(o.TEXTURE_2D,l),mt(o),o.texStorage2D(o.TEXTURE_2D,1,o[r],i,s),l}function he(o,e,t,n,r,i){let[,s,a,l,c]=Xe[t],u=Ke(o),h=u*l,m=Math.floor(n.length/h),p=Math.ceil(i/u);o.bindTexture(o.TEXTURE_2D,e),o.pixelStorei(o.UNPACK_ALIGNMENT,1);for(let g=Math.floor(r/u);g<Math.min(m,p);g+=256){let v=Math.min(256,m-g,p-g);o.texSubImage2D(o.TEXTURE_2D,0,0,g,u,v,o[s],o[a],n.subarray(g*h,(g+v)*h))}if(p>m){let g=new c(h);g.set(n.subarray(m*h)),o.texSubImage2D(o.TEXTURE_2D,0,0,m,u,1,o[s],o[a],g)}}function Q(o,e,t,n){let r=Math.ceil(t.length/Xe[e][3]),i=ye(o,e,r,n);return he(o,i,e,t,0,r),i}function _e(o,e,t,n){let r=e.length/4-3,[i,s]=n?t.map(a=>Math.log10(a)):t;return[Q(o,"rgba8",e,"colours"),r,[i,s,r/Math.max(s-i,1e-30)]]}function M(o,e,t,n){let r=o.createTexture();return o.bindTexture(o.TEXTURE_2D,r),mt(o),o.texStorage2D(o.TEXTURE_2D,1,e,t,n),r}function z(o,e,t){let n=o.createFramebuffer();return o.bindFramebuffer(o.FRAMEBUFFER,n),o.framebufferTexture2D(o.FRAMEBUFFER,o.COLOR_ATTACHMENT0,o.TEXTURE_2D,e,0),t&&o.framebufferTexture2D(o.FRAMEBUFFER,o.DEPTH_ATTACHMENT,o.TEXTURE_2D,t,0),n}var G=class{constructor(e,t){f(this,"gl",e);f(this,"name",t);f(this,"bytes");f(this,"floats");f(this,"words");f(this,"buffer");f(this,"binding");this.bytes=new ArrayBuffer(ve[t].bytes),this.floats=new Float32Array(this.bytes),this.words=new Uint32Array(this.bytes),this.buffer=e.createBuffer(),this.binding=Object.keys(ve).indexOf(t),e.bindBuffer(e.UNIFORM_BUFFER,this.buffer),e.bufferData(e.UNIFORM_BUFFER,this.bytes.byteLength,e.DYNAMIC_DRAW)}write(e,t=[]){for(let[n,r]of Object.entries(e)){let i=ve[this.name].fields[n]/4,s=t.includes(n)?this.words:this.floats;typeof r=="number"?s[i]=r:s.set(r,i)}this.upload()}fill(e){new Uint8Array(this.bytes).set(e),this.upload()}upload(){this.gl.bindBuffer(this.gl.UNIFORM_BUFFER,this.buffer),this.gl.bufferSubData(this.gl.UNIFORM_BUFFER,0,new Uint8Array(this.bytes))}bind(){this.gl.bindBufferBase(this.gl.UNIFORM_BUFFER,this.binding,this.buffer)}};var $t=1024,xe=16,en=16,tn=.1,nn=[4,8,11,15],pt=0,At=3,Le=5;function gt(o,e,t,n){if(!o||!(o.data instanceof Uint32Array)||o.data.length!==t*n)throw new T(`The file's ${e} do not fit its header. Copy or make it again.`);return o.data}function fe(o){let e=Math.ceil(o.byteLength/4);if(o.byteOffset%4===0&&o.byteOffset+4*e<=o.buffer.byteLength)return new Uint32Array(o.buffer,o.byteOffset,e);let t=new Uint8Array(4*e);return t.set(new Uint8Array(o.buffer,o.byteOffset,o.byteLength)),new Uint32Array(t.buffer)}function vt(o,e){return e===8?o:new Uint16Array(o.slice().buffer)}var Ie=class{constructor(e,t){f(this,"gl",e);f(this,"archive",t);f(this,"blocks",[]);f(this,"streamlines");f(this,"points");f(this,"bounds");f(this,"reference");f(this,"toData");f(this,"coding");f(this,"budget",256<<20);f(this,"parameters");f(this,"decodeProgram",null);f(this,"rotationBlock");f(this,"frameForDecoding");f(this,"textures",{});f(this,"itemBuffer");f(this,"toItems");f(this,"feedback");f(this,"scratch",null);f(this,"scratchBytes",0);f(this,"share",15);f(this,"itemBytes",15*xe);f(this,"kinds",new Set);f(this,"table");f(this,"done",0);f(this,"shares",0);f(this,"before",0);f(this,"open",null);f(this,"growing",{});f(this,"values",[]);f(this,"held",0);f(this,"clock",0);f(this,"fiblets");f(this,"decodeArray");f(this,"indices",null);f(this,"arrays",[null,null]);let{header:n,arrays:r}=t;if(n.format!=="fiblets")throw new T("The file is no .fiblets file: its header says something else.");if(![2,4,5].includes(n.version))throw new T(`The file is of version ${n.version}; this page reads versions 2, 4 and 5. Make the page again with a newer pvfiblets.`);let i=this.parameters=n.parameters,s=this.fiblets=n.n_fiblets;this.streamlines=n.n_streamlines,this.points=n.n_points,this.bounds=n.bounds;let a=gt(r.get("anchors.npy"),"anchors",2,s),l=gt(r.get("decoding.npy"),"records",3,s),c=r.get("codes.npy"),u=r.get("pages.npy");if(!c||!(c.data instanceof Uint8Array)||!u||!(u.data instanceof BigInt64Array))throw new T("The file's codes or pages are missing. Copy or make it again.");let h=this.table=Array.from(u.data,Number),m=Math.ceil(s/(1<<ae));if(h.length!==3*(m+1)||h[3*m+1]!==c.data.length||h[3*m+2]!==this.points)throw new T("The file's table of pages does not fit its records. Copy or make it again.");let p=i.anchor_bits===32?r.get("anchors_low.npy"):void 0;if(i.anchor_bits===32&&!(p?.data instanceof Uint16Array&&p.data.length===3*s))throw new T("The lower halves of the file's anchors are missing. Copy or make it again.");let g=i.anchor_bits===32?4294967295:65535;this.reference=[0,1,2].map(d=>{let A=(this.bounds[2*d]+this.bounds[2*d+1])/2,b=i.anchor_scale[d];return b>0&&Number.isFinite(A)?Math.round(Math.min(Math.max((A-i.origin[d])/b,0),g)):0}),this.toData=new Float64Array([1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]);for(let d=0;d<3;++d)this.toData[12+d]=i.origin[d]+i.anchor_scale[d]*this.reference[d];this.grow("anchor_texels","rg32ui",a,"anchors"),this.grow("decoding_texels","r32ui",l,"records"),this.grow("code_texels","r32ui",fe(c.data),"codes"),p&&this.grow("anchor_low_texels","r32ui",fe(p.data),"anchors");let v=new Uint32Array(4*Math.max(m,1));for(let d=0;d<m;++d)for(let A=0;A<3;++A)v[4*d+A]=h[3*d+A];this.textures.page_texels=Q(e,"rgba32ui",v,"pages"),this.coding=new G(e,"Coding"),this.coding.write({anchor_scale:i.anchor_scale,radius_scale:0,step_low:i.step_lo,step_span:i.step_hi-i.step_lo,lattice_edge:i.lattice,end_vector_scale:0,rotation_scales:lt}),this.rotationBlock=new G(e,"Rotations"),this.rotationBlock.fill(ct),this.frameForDecoding=new G(e,"Frame"),this.frameForDecoding.write({reference:this.reference},["reference"]),this.feedback=e.createTransformFeedback(),this.decodeArray=e.createVertexArray(),e.bindVertexArray(this.decodeArray),e.enableVertexAttribArray(0),e.bindVertexArray(null)}grow(e,t,n,r){let i=this.textures[e]=ye(this.gl,t,t==="rg32ui"?n.length/2:n.length,r);this.growing[e]={texture:i,format:t,data:n}}fill(e,t,n){let r=this.growing[e];r&&he(this.gl,r.texture,r.format,r.data,t,n)}sharesOf(e,t=this.share){let n=P("last",this.growing.decoding_texels.data[3*e+2])+1,r=this.growing.anchor_texels.data[2*e+1]>>>31;return n%t===0&&!r?n/t:Math.ceil((n+(r?1:2))/t)}begin(e){let t=this.gl,r=nn.map(l=>{let c=0,u=0;for(let h=0;h<e;++h){let m=this.sharesOf(h,l);c+=m*l*(1+.05*m),u+=m}return{share:l,cost:c,total:u}}).reduce((l,c)=>c.cost<l.cost?c:l),i=this.fiblets-e;this.share=r.share,this.itemBytes=this.share*xe;let s=this.points;for(let l=0;l<e;++l)s-=P("last",this.growing.decoding_texels.data[3*l+2])+1;let a=Math.max(r.total+Math.floor((Math.max(s,0)+(this.share+1)*i)/this.share),1);this.toItems=new Uint32Array(4*a),this.textures.items=ye(t,"rgba32ui",a,"shares of fiblets"),this.itemBuffer=t.createBuffer(),t.bindBuffer(t.ARRAY_BUFFER,this.itemBuffer),t.bufferData(t.ARRAY_BUFFER,8*a,t.STATIC_DRAW)}advance(e){let t=this.gl,n=this.done,r=Math.min(e,this.fiblets),i=this.parameters,{table:s}=this;if(r<=n&&this.fiblets)return;n||this.begin(r);let a=this.archive.arrays.get("rank_to_id.npy")?.data,l=this.archive.arrays.get("anchors_low.npy")?.data,c=this.growing.anchor_texels.data,u=this.growing.decoding_texels.data,h=this.toItems,m=s[s.length-2],p=this.shares,g=2*i.largest_radius,v=this.kinds.size,d=p,A=this.open,b=0;for(let w=n;w<r;++w)b+=this.sharesOf(w);let x=new Uint32Array(2*b),F=()=>{A&&(A.more=1,this.blocks.push(A))};for(let w=n;w<r;++w){let E=3*(w>>ae),B=c[2*w+1],C=u[3*w+2],D=P("rank",B)+s[E],I=P("last",C)+1,U=a?Number(a[D]):D,S=P("begin",B),O=P("end",B),N=P("code",u[3*w+1])+s[E+1],ee=P("point",C)+s[E+2],X=this.sharesOf(w);if(I>60||4*(d+X)>h.length||!(U>=0&&U<this.streamlines)||N>m||ee+I>this.points)throw new T(`Record ${w} of the file is damaged. Copy or make it again.`);let se=P("kind",C),oe=se===At&&(P("step",u[3*w+1])&7)===Le;this.kinds.add(oe?Le:se),w%$t===0&&(F(),A={firstItem:d,items:0,more:0,bounds:[1/0,-1/0,1/0,-1/0,1/0,-1/0],buffer:null,used:0,shapes:null,likely:null,likelies:0});let W=[c[2*w]&65535,c[2*w]>>>16,B&65535];for(let _=0;_<3;++_){let te=i.origin[_]+i.anchor_scale[_]*(l?W[_]*65536+l[3*w+_]:W[_]);A.bounds[2*_]=Math.min(A.bounds[2*_],te-g),A.bounds[2*_+1]=Math.max(A.bounds[2*_+1],te+g)}S&&(this.before=0);for(let _=0;_<X;++_,++d)h[4*d]=U,h[4*d+1]=ee,h[4*d+2]=I|S<<6|O<<7|_<<8,h[4*d+3]=this.before,x[2*(d-p)]=w,x[2*(d-p)+1]=_;this.before+=I,A.items+=X}this.open=A,r===this.fiblets&&A&&this.blocks.push(A),this.shares=d,this.done=r,this.kinds.size>v&&(this.decodeProgram=null),he(t,this.textures.items,"rgba32ui",h,p,d),t.bindBuffer(t.ARRAY_BUFFER,this.itemBuffer),t.bufferSubData(t.ARRAY_BUFFER,8*p,x),this.fill("anchor_texels",n,r),this.fill("decoding_texels",3*n,3*r),this.fill("anchor_low_texels",Math.floor(1.5*n),Math.ceil(1.5*r)),this.fill("code_texels",this.countBefore(n,1)>>2,this.countBefore(r,1)+3>>2);for(let{texture:w,format:E,data:B}of this.values)he(t,w,E,B,this.countBefore(n,2),this.countBefore(r,2))}countBefore(e,t){return this.table[3*Math.ceil(e/(1<<ae))+t]}pointValues(e){let t=this.archive.header.per_point?.[e],n=t&&this.archive.arrays.get(t.member);if(!n||n.data.length!==this.points)throw new T(`The file has no values ${e} for its points.`);let r=this.archive.arrays.get(t.table);if(!(r?.data instanceof Float32Array))throw new T(`The file does not say what the codes of ${e} mean. Make the page again.`);return this.codedValues(e,n.data,r.data,t)}codedValues(e,t,n,{lo:r,hi:i,reference:s}){if(t.length!==this.points)throw new T(`The file has ${this.points} points, but ${t.length} values ${e}.`);let a=t instanceof Uint16Array,l=a?"r16ui":"r8ui",c=ye(this.gl,l,this.points,"values of points");this.values.push({texture:c,format:l,data:t}),he(this.gl,c,l,t,0,this.countBefore(this.done,2));let u=new Float32Array(a?65536:256).fill(NaN);u.set(n.subarray(0,u.length));let h=new Uint32Array(u.buffer);return{name:e,texture:c,table:Q(this.gl,"r32ui",h,"values of codes"),range:[r,i],reference:s}}forget({texture:e,table:t}){this.values=this.values.filter(n=>n.texture!==e),this.gl.deleteTexture(e),this.gl.deleteTexture(t)}decoder(){let e=["DIRECTION"];return this.textures.anchor_low_texels&&e.push("ANCHORS_LOW"),[...this.kinds].some(t=>t!==pt&&t!==Le)&&e.push("LATTICE"),this.kinds.has(At)&&e.push("WIDE_LATTICE"),this.kinds.has(Le)&&e.push("SPLINE"),this.decodeProgram??(this.decodeProgram=new ue(this.gl,"page/decode.vert","page/none.frag",e,Array.from({length:this.share},(t,n)=>`o${n}`)))}decode(e,t){let n=this.gl,r=e.items+e.more;this.coding.bind(),this.rotationBlock.bind(),this.frameForDecoding.bind();let{items:i,...s}=this.textures;this.decoder().use().textures(s).uints({chunk_fiblets:this.fiblets,share_size:this.share}),n.bindVertexArray(this.decodeArray),n.bindBuffer(n.ARRAY_BUFFER,this.itemBuffer),n.vertexAttribIPointer(0,2,n.UNSIGNED_INT,8,8*e.firstItem),n.bindBuffer(n.ARRAY_BUFFER,null),n.enable(n.RASTERIZER_DISCARD),n.bindTransformFeedback(n.TRANSFORM_FEEDBACK,this.feedback),n.bindBufferRange(n.TRANSFORM_FEEDBACK_BUFFER,0,t,0,r*this.itemBytes),n.beginTransformFeedback(n.POINTS),n.drawArrays(n.POINTS,0,r),n.endTransformFeedback(),n.bindBufferBase(n.TRANSFORM_FEEDBACK_BUFFER,0,null),n.bindTransformFeedback(n.TRANSFORM_FEEDBACK,null),n.disable(n.RASTERIZER_DISCARD),n.bindVertexArray(null)}size(e){return(e.items+e.more)*this.itemBytes+2*xe}newBuffer(e){let t=this.gl,n=t.createBuffer();return t.bindBuffer(t.ARRAY_BUFFER,n),t.bufferData(t.ARRAY_BUFFER,e,t.DYNAMIC_COPY),t.bindBuffer(t.ARRAY_BUFFER,null),n}pointsOf(e){if(e.used=++this.clock,e.buffer)return e.buffer;let t=this.size(e);return this.held+t<=this.budget?(this.held+=t,e.buffer=this.newBuffer(t),this.decode(e,e.buffer),e.buffer):(this.scratchBytes<t&&(this.scratch&&this.gl.deleteBuffer(this.scratch),this.scratch=this.newBuffer(this.scratchBytes=t)),this.decode(e,this.scratch),this.scratch)}get items(){return this.textures.items}segments(e){return e*this.share}get longestStep(){return this.kinds.size===1&&this.kinds.has(pt)?2*this.parameters.step_hi:1/0}draw(e,t,n,r){return this.drawRun(e,t,0,Math.max(1,Math.round(n)),r)}drawRun(e,t,n,r,i){let s=this.gl,a=(r-n)*this.share;return this.aim(e,t,n,i),i?s.drawArrays(s.POINTS,0,a):s.drawArraysInstanced(s.TRIANGLE_STRIP,0,4,a),s.bindVertexArray(null),a}aim(e,t,n,r){let i=this.gl,s=this.pointsOf(e);t.use().ints({first_item:e.firstItem+n,share_size:this.share}),i.bindVertexArray(this.segmentArray(r)),i.bindBuffer(i.ARRAY_BUFFER,s);for(let a=0;a<3;++a)i.vertexAttribIPointer(a,4,i.UNSIGNED_INT,xe,n*this.itemBytes+a*xe)}likely(e){return e.likely||(e.likely=new Uint8Array(e.items).fill(1,0,e.likelies=Math.max(1,Math.round(tn*e.items)))),e.likely}look(e,t,n,r,i,s){let a=new Uint8Array(e.items),l=this.likely(e),c=new Uint8Array(e.items);ht(e.shapes??(e.shapes=this.shapesOf(e)),t,n,r,i,s,a),e.likelies=0;for(let u=0;u<c.length;++u)c[u]=a[u]&~l[u],e.likelies+=a[u];return e.likely=a,c}shapesOf(e){let t=this.toItems,{share:n}=this;return ut(this.slotsOf(e),e.items,n,r=>{let i=t[4*(e.firstItem+r)+2],s=i>>>7&1,a=i&63;return Math.min(a+1-s-n*(i>>>8),n+1)})}slotsOf(e){let t=this.gl,n=new Float32Array((e.items+e.more+1)*this.share*4);return t.bindBuffer(t.ARRAY_BUFFER,this.pointsOf(e)),t.getBufferSubData(t.ARRAY_BUFFER,0,n,0,(e.items+e.more)*this.share*4),t.bindBuffer(t.ARRAY_BUFFER,null),n}drawSome(e,t,n,r,i=1/0){let s=this.gl,{share:a}=this,l=0;if(!r){let h=0,m=0;for(let p=0;p<n.length&&m<i;++p){if(!n[p])continue;let g=p+1;++m;for(let v=g;v<Math.min(n.length,g+en)&&m<i;++v)n[v]&&(g=v+1,++m);h+=this.drawRun(e,t,p,g,r),p=g}return h}let c=Math.min(i,n.length),u=new Uint32Array(c*a);for(let h=0,m=0;h<n.length&&m<c;++h){if(!n[h])continue;let p=this.toItems[4*(e.firstItem+h)+2],g=p&63,v=g-((p&128)!==0&&g>1?1:0);for(let d=h*a,A=d+Math.min(v-a*(p>>>8),a);d<A;++d)u[l++]=d;++m}return l?(this.aim(e,t,0,r),s.bindBuffer(s.ELEMENT_ARRAY_BUFFER,this.indices??(this.indices=s.createBuffer())),s.bufferData(s.ELEMENT_ARRAY_BUFFER,u.subarray(0,l),s.STREAM_DRAW),s.drawElements(s.POINTS,l,s.UNSIGNED_INT,0),s.bindVertexArray(null),l):0}segmentArray(e){let t=e?1:0;if(!this.arrays[t]){let n=this.gl;n.bindVertexArray(this.arrays[t]=n.createVertexArray());for(let r=0;r<3;++r)n.enableVertexAttribArray(r),n.vertexAttribDivisor(r,e?0:1)}return this.arrays[t]}*decoded(e,t=0){let n=this.toItems;for(let r of this.blocks.slice(t)){if(!e(r))continue;let i=this.slotsOf(r);for(let s=r.firstItem;s<r.firstItem+r.items;++s){if(n[4*s+2]>>>8)continue;let a=n[4*s+2]&63,l=(n[4*s+2]&128)!==0,c=4*this.share*(s-r.firstItem);yield[n[4*s],i.subarray(c,c+4*(a+(l?0:1))),(n[4*s+2]&64)!==0]}}}blocksOf(e){let t=this.toItems;return n=>{for(let r=n.firstItem;r<n.firstItem+n.items;++r)if(t[4*r]===e)return!0;return!1}}world(e,t){return[0,1,2].map(n=>this.toData[12+n]+e[4*t+n])}pointsOfStreamline(e){let t=[];for(let[n,r]of this.decoded(this.blocksOf(e)))if(n===e)for(let i=0;4*i<r.length;++i)t.push(this.world(r,i));return t}through(e,t,n=0,r=new Uint8Array(this.streamlines)){let{at:i,size:s}=e,a=({bounds:l})=>{let c=[0,1,2,3,4,5,6,7].map(u=>L(t,[l[u&1],l[2+(u>>1&1)],l[4+(u>>2)]]));return[0,1,2].every(u=>c.some(h=>h[u]>=i[u]-s[u])&&c.some(h=>h[u]<=i[u]+s[u]))};for(let[l,c]of this.decoded(a,n)){if(r[l])continue;let u=He(e,L(t,this.world(c,0)));for(let h=0;h<c.length&&!r[l];h+=4){let m=He(e,L(t,this.world(c,Math.min(h+4,c.length-4)/4)));ft(e,u,m)&&(r[l]=1),u=m}}return r}release(){let e=this.gl;for(let t of this.blocks)t.buffer&&e.deleteBuffer(t.buffer);for(let t of Object.values(this.textures))e.deleteTexture(t);for(let t of[this.scratch,this.indices,this.itemBuffer])t&&e.deleteBuffer(t)}};var bt="http://www.w3.org/2000/svg",wt="Your browser does not let this page read its image; allow that to";function y(o,e={},...t){let n=document.createElement(o);for(let[r,i]of Object.entries(e))n.setAttribute(r,i);return n.append(...t),n}var $=o=>Number.isFinite(o)?String(Number(o.toPrecision(4))):"no value";function V(o,e,t,n,r){let i=(t-e)/200||1,s=y("output",{},$(n)),a=y("input",{type:"range",min:String(e),max:String(t),step:String(i),value:String(n)});return a.addEventListener("input",()=>{s.textContent=$(a.valueAsNumber),r(a.valueAsNumber)}),y("label",{},y("span",{},o),a,s)}function Ue(o,e,t){let n=y("input",{type:"checkbox"});return n.checked=e,n.addEventListener("change",()=>t(n.checked)),y("label",{},n,y("span",{},o))}function de(o,e){let t=y("button",{type:"button"},o);return t.addEventListener("click",e),t}function ie(o,...e){return y("fieldset",{},y("legend",{},o),...e)}var rn=[["Left",[1,0,0],[0,0,1]],["Right",[-1,0,0],[0,0,1]],["Front",[0,-1,0],[0,0,1]],["Back",[0,1,0],[0,0,1]],["Top",[0,0,-1],[0,1,0]],["Bottom",[0,0,1],[0,1,0]]];function sn(o){let e=Y(o.table),t=e.length/4,n=y("canvas",{width:String(t),height:"1",role:"img","aria-label":`Colours from ${$(o.clim[0])} to ${$(o.clim[1])}`}),r=n.getContext("2d"),i=r.createImageData(t,1);if(i.data.set(e),r.putImageData(i,0,0),o.labels){let c=o.labels.map(({name:u,colour:h})=>{let m=y("i",{"aria-hidden":"true"});return m.style.background=`rgb(${h.join(",")})`,y("li",{},m,u)});return y("figure",{class:"bar"},y("figcaption",{},o.title),y("ul",{tabindex:"0","aria-label":o.title},...c))}let[s,a]=o.clim,l=o.log?Math.sqrt(s*a):(s+a)/2;return y("figure",{class:"bar"},y("figcaption",{},o.title),n,y("div",{class:"ticks","aria-hidden":"true"},...[s,l,a].map(c=>y("span",{},$(c)))))}var ke=class{constructor(e,t){f(this,"renderer",e);f(this,"data",t);f(this,"told",null);f(this,"status",document.getElementById("status"));f(this,"axes",[]);f(this,"choices",new Map);f(this,"picked",null);f(this,"regions",[]);f(this,"outlines",document.createElementNS(bt,"svg"));f(this,"later",0);let n=document.getElementById("over"),{scene:r}=e,i=y("details",{id:"panel"},y("summary",{},"Scene"));i.append(this.layers(),...this.groups(),this.views(),this.cut(),...this.ranges(),this.regionList()),n.append(this.outlines,i),r.bars.length&&n.append(y("div",{id:"bars"},...r.bars.map(sn))),n.append(this.orientation()),e.restored=()=>{for(let s of this.choices.values())s.apply()},e.presented=()=>this.follow(),e.grown=()=>this.grown(),this.follow()}layers(){let{renderer:e}=this,t=[];return e.scene.layers.forEach(n=>{t.push(Ue(n.name,n.visible,r=>{n.visible=r,e.change()})),n.kind==="fiblets"?t.push(V(n.ends?"Point size":"Line width",.5,n.ends?20:10,n.line_width,r=>{n.line_width=r,e.change(!0)})):t.push(V("Opacity",0,1,n.opacity,r=>{n.opacity=r,e.change(!0)}))}),ie("Layers",...t)}views(){let{renderer:e}=this,t=rn.map(([n,r,i])=>de(n,()=>{e.look(r,i),e.change()}));return t.push(de("Reset",()=>{let{camera:n}=e.scene;n?Object.assign(e.camera.state,structuredClone(n)):e.look(),e.change()})),t.push(de("Save image",()=>this.save())),ie("View",y("div",{class:"buttons"},...t))}save(){let{renderer:e}=this;e.settled().then(()=>{if(!e.reads())return void(this.status.textContent=`${wt} save images.`);let t=y("canvas",{width:String(e.width),height:String(e.height)}),n=t.getContext("2d"),r=n.createImageData(e.width,e.height);r.data.set(e.pixels()),n.putImageData(r,0,0),t.toBlob(i=>{let s=y("a",{href:URL.createObjectURL(i),download:"picture.png"});s.click(),setTimeout(()=>URL.revokeObjectURL(s.href),6e4)})})}cut(){let{renderer:e}=this,t=e.scene.bounds,n=y("select",{"aria-label":"Cut across"});for(let l of["nothing","left to right","back to front","bottom to top"])n.append(y("option",{},l));let r=y("div"),i=0,s=0,a=()=>{let l=n.selectedIndex-1,c=u=>[0,1,2].map(h=>h===l?u:0).concat(-u*i+s/2);e.planes=l<0?[]:[c(1),c(-1)],e.change(!0)};return n.addEventListener("change",()=>{let l=n.selectedIndex-1;if(r.replaceChildren(),l>=0){let c=t[2*l],u=t[2*l+1];i=(c+u)/2,s=(u-c)/8,r.append(V("Position",c,u,i,h=>{i=h,a()}),V("Thickness",(u-c)/200,u-c,s,h=>{s=h,a()}))}a()}),ie("Slab across",n,r)}choiceOf(e){let t=this.choices.get(e.index);return t||this.choices.set(e.index,t=new De(e,e.layer.kept===void 0?null:this.data[e.layer.kept])),t}ranges(){let{renderer:e}=this,t=[];for(let n of e.lines){let{values:r,layer:i}=n;if(r){let[s,a]=r.range,l=[s,a],c=()=>{e.lines[n.index].shownValues=l[0]>s||l[1]<a?[l[0],l[1]]:[1,0],e.change(!0)};t.push(ie(r.name,V("Minimum",s,a,s,u=>{l[0]=u,c()}),V("Maximum",s,a,a,u=>{l[1]=u,c()})))}for(let s of i.controls??[]){if(s.data===void 0)continue;let a=this.data[s.data],l=new Float32Array(a.slice().buffer),[c,u]=s.range,h=m=>p=>{this.choiceOf(e.lines[n.index]).set(s,l,m,p),e.change(!0)};t.push(ie(s.name,V("Minimum",c,u,c,h(0)),V("Maximum",c,u,u,h(1))))}}return t}groups(){return this.renderer.lines.filter(({layer:e})=>e.groups?.length).map(e=>{let t=this.choiceOf(e),n=e.layer.groups.map(({name:r,data:i})=>{let s=fe(this.data[i]);return t.groups.push(s),Ue(r,!0,a=>{a?t.hidden.delete(s):t.hidden.add(s),t.apply(),this.renderer.change()})});return ie(`Groups of ${e.layer.name}`,...n)})}regionList(){let e=y("div"),{renderer:t}=this,n=t.scene.bounds,r=Math.hypot(n[1]-n[0],n[3]-n[2],n[5]-n[4]),i=s=>()=>{let a=this.picked?L(this.picked.lines.model,this.picked.place).slice(0,3):[0,1,2].map(c=>(n[2*c]+n[2*c+1])/2),l={ball:s,at:a,size:[r/40,r/40,r/40],on:!0,inverted:!1};this.regions.push(l),e.append(this.regionRow(l,r)),this.update(l)};return ie("Regions",y("div",{class:"buttons"},de("Add a ball",i(!0)),de("Add a box",i(!1))),e)}regionRow(e,t){let{renderer:n}=this,r=n.scene.bounds,i=`${e.ball?"Ball":"Box"} ${this.regions.length}`,s=()=>{window.clearTimeout(this.later),this.later=window.setTimeout(()=>this.update(e),120),this.drawOutlines()},a=(c,u)=>V(c,t/1e3,t/4,e.size[u[0]],h=>{for(let m of u)e.size[m]=h;s()}),l=y("details",{},y("summary",{},i),Ue("On",!0,c=>{e.on=c,this.choose()}),Ue("Exclude",!1,c=>{e.inverted=c,this.choose()}),...["x","y","z"].map((c,u)=>V(`${c}, mm`,r[2*u],r[2*u+1],e.at[u],h=>{e.at[u]=h,s()})),...e.ball?[a("Radius, mm",[0,1,2])]:["x","y","z"].map((c,u)=>a(`Half-width ${c}, mm`,[u])),y("div",{class:"buttons"},de(`Remove ${i.toLowerCase()}`,()=>{l.remove(),this.regions.splice(this.regions.indexOf(e),1);for(let c of this.choices.values())c.regions.delete(e);this.choose()})));return l.open=!0,l}update(e){if(this.regions.includes(e)){for(let t of this.renderer.lines)this.choiceOf(t).look(e,!1);this.choose()}}grown(){if(this.regions.length){for(let e of this.choices.values())for(let t of this.regions)e.look(t,!0);this.choose()}}choose(){let e=0;this.drawOutlines();for(let t of this.choices.values())t.apply(),e+=t.count;this.status.textContent=this.regions.some(t=>t.on)?`${e} streamlines are shown`:"",this.renderer.change()}pick(e,t){let{renderer:n}=this,r=n.reads()?n.pick(e,t):null;if(this.unmark(),r){let{lines:i,streamline:s,value:a}=r,l=n.placeOf(i,s,e,t),c=L(i.model,l).slice(0,3);this.say(i,s,a,c),this.picked={lines:i,streamline:s,place:l},this.told?.({layer:n.scene.layers.indexOf(i.layer),streamline:s,place:c})}else this.told?.(null);n.reads()||(this.status.textContent=`${wt} pick streamlines.`),n.change()}mark(e){this.unmark();let t=e&&this.renderer.lines.find(({layer:n})=>n===this.renderer.scene.layers[e.layer]);if(e&&t&&e.streamline>=0&&e.streamline<t.set.streamlines){let{streamline:n}=e,r=t.set.pointsOfStreamline(n),i=r[r.length>>1];this.say(t,n,null,e.place??[]),i&&(this.picked={lines:t,streamline:n,place:i})}this.renderer.change()}unmark(){for(let e of this.renderer.lines)e.marked=k;this.picked=null,this.status.textContent=""}say(e,t,n,r){e.marked=t;let i=[`Streamline ${t} of ${e.layer.name}`];n!==null&&e.values&&i.push(`${e.values.name} ${$(n)}`);for(let s of e.layer.controls??[])s.data!==void 0&&i.push(`${s.name} ${$(new Float32Array(this.data[s.data].slice().buffer)[t])}`);r.length&&i.push(`at ${r.map($).join(", ")} mm`),this.status.textContent=i.join("; ")}orientation(){let t=(this.renderer.scene.letters?[["L","R"],["P","A"],["I","S"]]:[["","x"],["","y"],["","z"]]).flat().map((n,r)=>y("span",{class:`axis a${r>>1}`},n));return this.axes=t,y("div",{id:"axes","aria-hidden":"true"},...t)}follow(){this.turnAxes(),this.drawOutlines()}drawOutlines(){let{renderer:e,outlines:t}=this,{camera:n,canvas:r}=e,i=r.clientWidth,s=r.clientHeight;if(!this.regions.length)return t.replaceChildren();let a=R(n.projection(i/s,e.scene.bounds),n.view());t.replaceChildren(...this.regions.map(l=>{let c=document.createElementNS(bt,"path"),u=[];for(let h of dt(l)){let m="M";for(let p of h){let[g,v,,d]=L(a,p);d>0&&u.push(`${m}${((g/d+1)*i/2).toFixed(1)} ${((1-v/d)*s/2).toFixed(1)}`),m=d>0?"L":"M"}}return c.setAttribute("d",u.join("")),c.setAttribute("opacity",l.on?"1":".3"),c}))}turnAxes(){let e=this.renderer.camera.view();this.axes.forEach((t,n)=>{let r=Z([0,1,2].map(l=>l===n>>1?1:0),n&1?1:-1),[i,s,a]=L(e,r,0);t.style.transform=`translate(${(i*32).toFixed(1)}px, ${(-s*32).toFixed(1)}px)`,t.style.zIndex=String(Math.round(100*a))})}};function We(o,e=()=>{}){let{canvas:t,camera:n}=o,r=new Map,i=0,s=0;t.addEventListener("pointerdown",l=>{t.focus(),t.setPointerCapture(l.pointerId),r.set(l.pointerId,{x:l.offsetX,y:l.offsetY}),i=0,s=l.button,l.preventDefault()}),t.addEventListener("contextmenu",l=>l.preventDefault());let a=l=>{r.delete(l.pointerId)&&(l.type==="pointerup"&&i<4&&s===0&&!r.size?e(l.offsetX,l.offsetY):o.change())};t.addEventListener("pointerup",a),t.addEventListener("pointercancel",a),t.addEventListener("pointermove",l=>{let c=r.get(l.pointerId);if(!c)return;let u=l.offsetX-c.x,h=l.offsetY-c.y,m=t.clientWidth,p=t.clientHeight;if(i+=Math.abs(u)+Math.abs(h),r.size===2){let g=[...r.entries()].find(([A])=>A!==l.pointerId)[1],v=[c.x-g.x,c.y-g.y],d=[l.offsetX-g.x,l.offsetY-g.y];n.dolly(Math.hypot(d[0],d[1])/Math.max(1,Math.hypot(v[0],v[1]))),n.roll((Math.atan2(d[1],d[0])-Math.atan2(v[1],v[0]))*180/Math.PI),n.pan(u/2/p,-h/2/p)}else s===1||l.shiftKey?n.pan(u/p,-h/p):s===2?n.dolly(Math.pow(1.1,-20*.2*h/(p/2)*5)):l.ctrlKey?n.roll(180*u/m):n.rotate(u/m,-h/p);c.x=l.offsetX,c.y=l.offsetY,o.change(!0)}),t.addEventListener("wheel",l=>{n.dolly(Math.pow(1.1,Math.max(-3,Math.min(3,-l.deltaY/50)))),o.change(!0),l.preventDefault()},{passive:!1}),t.addEventListener("keydown",l=>{let u={ArrowLeft:()=>l.shiftKey?n.pan(-.04,0):n.rotate(-.04,0),ArrowRight:()=>l.shiftKey?n.pan(.04,0):n.rotate(.04,0),ArrowUp:()=>l.shiftKey?n.pan(0,.04):n.rotate(0,.04),ArrowDown:()=>l.shiftKey?n.pan(0,-.04):n.rotate(0,-.04),"+":()=>n.dolly(1.1),"=":()=>n.dolly(1.1),"-":()=>n.dolly(.9090909090909091),Enter:()=>e(t.clientWidth/2,t.clientHeight/2)};l.altKey||l.metaKey||!u[l.key]||(u[l.key](),o.change(!0),l.preventDefault())})}var Je=o=>Array.isArray(o)&&o.length===3&&o.every(Number.isFinite);function yt(o,e){let{parent:t}=window;if(t===window)return;let n=s=>t.postMessage({pvfiblets:s},"*"),{state:r}=o.camera,i=JSON.stringify(r);window.addEventListener("message",s=>{let a=s.source===t?s.data?.pvfiblets:void 0;if(!a)return;let{camera:l,picked:c}=a;if(l&&Je(l.position)&&Je(l.focal_point)&&Je(l.up)&&l.view_angle>0&&l.parallel_scale>0){Object.assign(r,l);let u=JSON.stringify(r);u!==i&&o.change(),i=u}c!==void 0&&e.mark(c)}),o.finished=()=>{let s=JSON.stringify(r);s!==i&&n({camera:JSON.parse(i=s)})},e.told=s=>n({picked:s}),n({ready:!0})}var Ee=class{constructor(e,t){f(this,"file",e);f(this,"bytes");f(this,"come",0);f(this,"whole",null);f(this,"waiting",[]);f(this,"had",[]);this.bytes=new Uint8Array(t)}async need(e,t){t<=e||this.had.some(([n,r])=>n<=e&&r>=t)||(this.whole||await this.tried(e,t),this.whole&&await this.upTo(t))}async tried(e,t){for(let n=2;;--n)try{return await this.ask(e,t)}catch(r){if(!(r instanceof TypeError))throw r;if(!n)throw new Error(`${this.file} cannot be read: the connection to its server broke, or there is no server. Files beside a page need one; "python -m http.server" is enough.`);await new Promise(i=>setTimeout(i,500))}}async ask(e,t){let n=await fetch(this.file,{headers:{Range:`bytes=${e}-${t-1}`}});if(!n.ok)throw new Error(`${this.file} cannot be read (${n.status}); it must lie beside this page.`);if(n.status!==206){this.whole?n.body?.cancel():this.whole=this.flow(n);return}let r=Number(/\/(\d+)$/.exec(n.headers.get("Content-Range")??"")?.[1]??this.bytes.length),i=new Uint8Array(await n.arrayBuffer());if(r!==this.bytes.length||i.length!==t-e)throw this.changed(r);this.bytes.set(i,e),this.had.push([e,t])}async flow(e){let t=e.body.getReader();for(;;){let{done:n,value:r}=await t.read();if(n)break;if(this.come+r.length>this.bytes.length)throw this.changed(this.come+r.length);this.bytes.set(r,this.come),this.come+=r.length,this.waiting=this.waiting.filter(i=>i.end<=this.come?i.resolve():!0)}if(this.come!==this.bytes.length)throw this.changed(this.come)}async upTo(e){e>this.come&&await Promise.race([this.whole,new Promise(t=>this.waiting.push({end:e,resolve:t}))])}changed(e){return new Error(`${this.file} has ${e} bytes, and this page was made with one of ${this.bytes.length}. Copy the page and its folder again.`)}};var je=6;function xt({leaves:o,program:e}){let t=[];for(let n of e)n>=0?t.push(o[n].ball?`sphere_holds(${n},z)`:`planes_hold(${n},${o[n].planes.length},z)`):n===-3?t.push(`!${t.pop()}`):t.push(`(${t.pop()}${n===-1?"&&":"||"}${t.pop()})`);return t[0]}function Et({leaves:o},e,t,n){let r=K(e),i=[t,n,1,1],s=[0,1,2,3];if(!r)return null;let a=new Float64Array(4*je*o.length),l=new Float64Array(4*o.length);return o.forEach(({centre:c,planes:u,ball:h},m)=>{let[p,g,v,d]=L(e,c),A=[p/d,g/d,v/d],b=d>0&&A.every(isFinite)?A.map((C,D)=>Math.min(Math.max(C,0),i[D])):[t/2,n/2,0],x=C=>{let D=s.map(I=>s.reduce((U,S)=>U+C[S]*r[S+4*I],0));return D[3]+=D[0]*b[0]+D[1]*b[1]+D[2]*b[2],D},F=C=>{let D=Math.max(...C.map((I,U)=>Math.abs(I*i[U])))||1;return C.map((I,U)=>Math.abs(I*i[U])<1e-30*D?0:I/D)};if(l.set(b,4*m),u&&u.forEach((C,D)=>a.set(F(x(C)),4*(je*m+D))),!h)return;let w=[...h,[0,0,0,1]].map(x),E=s.map(C=>s.map(D=>w.reduce((I,U,S)=>I+(S<3?1:-1)*U[C]*U[D],0))),B=Math.max(...s.flatMap(C=>s.map(D=>Math.abs(E[C][D]*i[C]*i[D]))))||1;a.set([E[0][0],E[1][1],2*E[0][1],E[3][3],2*E[0][3],2*E[1][3],E[0][2],E[1][2],E[2][2],E[2][3]].map(C=>C/B),4*je*m)}),{rays_rows:a,rays_centres:l}}var Me=class{constructor(e,t,n,r,i,s){f(this,"gl",e);f(this,"layer",t);f(this,"index",n);f(this,"set");f(this,"model");f(this,"values",null);f(this,"colours",null);f(this,"table",null);f(this,"tableSize",1);f(this,"tableRange",[0,1,1]);f(this,"kept",null);f(this,"chosen",null);f(this,"opacities",null);f(this,"keptPoints",null);f(this,"shownValues",[1,0]);f(this,"marked",k);this.set=s??new Ie(e,i),this.set.advance(i.ready),this.model=new Float64Array(t.matrix??be());let{colours:a}=t;if(a.codes){let{codes:l}=a;this.values=this.set.codedValues(a.values,vt(r[l.data],l.bits),new Float32Array(r[l.table].slice().buffer),l)}else a.values!==void 0&&(this.values=this.set.pointValues(a.values));if(a.data!==void 0&&(this.colours=Q(e,"rgba8",r[a.data],"colours")),a.table!==void 0){let l=a.clim.map(c=>c-(this.values?.reference??0));[this.table,this.tableSize,this.tableRange]=_e(e,Y(a.table),l,!!a.log)}t.kept!==void 0&&this.keep(r[t.kept]),t.chosen&&(this.chosen=Q(e,"r8ui",r[t.chosen.data],"streamlines")),t.through?.opacities!==void 0&&(this.opacities=Q(e,"r8ui",r[t.through.opacities],"streamlines")),t.kept_points!==void 0&&(this.keptPoints=Q(e,"r32ui",fe(r[t.kept_points]),"points"))}release(){this.values&&this.set.forget(this.values);for(let e of[this.colours,this.table,this.kept,this.chosen,this.opacities,this.keptPoints])e&&this.gl.deleteTexture(e)}get byPoint(){return this.layer.colours.mode==="point_packed"}get colouring(){let{mode:e,log:t}=this.layer.colours;return[`COLOUR_${e.toUpperCase()}`,...t?["TABLE_LOGARITHM"]:[]]}keep(e){this.kept&&this.gl.deleteTexture(this.kept),this.kept=e&&Q(this.gl,"r8ui",e,"streamlines")}};function on(o,e,t){let n=e.slice(0,6).map(r=>[0,1,2,3].map(i=>r[0]*t[4*i]+r[1]*t[4*i+1]+r[2]*t[4*i+2]+r[3]*t[4*i+3]));o.ints({plane_count:n.length}),n.forEach((r,i)=>o.set({[`planes[${i}]`]:r}))}var Se=class{constructor(e,t,n){f(this,"gl",e);f(this,"layer",t);f(this,"array");f(this,"buffers",[]);f(this,"count");f(this,"table",null);f(this,"tableSize",1);f(this,"tableRange",[0,1,1]);f(this,"model");this.model=new Float64Array(t.matrix??[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]),this.array=e.createVertexArray(),e.bindVertexArray(this.array);let r=(s,a,l,c,u)=>{let h=e.createBuffer();e.bindBuffer(e.ARRAY_BUFFER,h),e.bufferData(e.ARRAY_BUFFER,a,e.STATIC_DRAW),e.enableVertexAttribArray(s),e.vertexAttribPointer(s,l,c,u,0,0),this.buffers.push(h)};r(0,n[t.places],3,e.FLOAT,!1),t.normals!==void 0&&r(1,n[t.normals],3,e.FLOAT,!1),t.colours!==void 0&&r(2,n[t.colours],4,e.UNSIGNED_BYTE,!0),t.values!==void 0&&(r(3,n[t.values],1,e.FLOAT,!1),[this.table,this.tableSize,this.tableRange]=_e(e,Y(t.table),t.clim,!!t.log)),t.edges&&r(4,n[t.edges.sides],1,e.UNSIGNED_BYTE,!1);let i=e.createBuffer();e.bindBuffer(e.ELEMENT_ARRAY_BUFFER,i),e.bufferData(e.ELEMENT_ARRAY_BUFFER,n[t.triangles],e.STATIC_DRAW),this.buffers.push(i),this.count=n[t.triangles].byteLength/4,e.bindVertexArray(null)}get translucent(){return this.layer.opacity<1}draw(e,t){let n=this.gl,{layer:r}=this,i=R(t.view,this.model),s=we(i),a=K(i),l=a?[a[0],a[4],a[8],a[1],a[5],a[9],a[2],a[6],a[10]]:s;e.use().set({clip_from_data:Re(R(t.projection,i)),view_from_data:Re(i),normal_to_view:l,parallel:t.parallel?1:0,opacity:r.opacity,reflects:r.reflects,sheen:r.sheen,edge_width:r.edges?r.edges.width*t.ratio:0,edge_colour:r.edges?.colour??[0,0,0,0]}),e.ints({smooth_normals:r.normals===void 0?0:1,lighting:r.lighting?1:0,by_value:this.table?1:0,colour_entries:this.tableSize}),e.textures({colour_table:this.table}).set({colour_range:this.tableRange,colour_reference:0}),t.lights(e),on(e,[...r.planes??[],...t.planes],this.model),n.bindVertexArray(this.array),r.normals===void 0&&n.vertexAttrib3f(1,0,0,1),r.colours===void 0&&n.vertexAttrib4f(2,r.colour[0],r.colour[1],r.colour[2],1),r.culled&&(n.enable(n.CULL_FACE),n.cullFace(r.culled.length>1?n.FRONT_AND_BACK:r.culled[0]==="front"?n.FRONT:n.BACK)),n.drawElements(n.TRIANGLES,this.count,n.UNSIGNED_INT,0),n.disable(n.CULL_FACE),n.bindVertexArray(null)}release(){for(let e of this.buffers)this.gl.deleteBuffer(e);this.gl.deleteVertexArray(this.array),this.table&&this.gl.deleteTexture(this.table)}depth(e){let t=this.layer.bounds,n=[(t[0]+t[1])/2,(t[2]+t[3])/2,(t[4]+t[5])/2];return-(e[2]*n[0]+e[6]*n[1]+e[10]*n[2]+e[14])}},Oe=class{constructor(e,t,n){f(this,"gl",e);f(this,"layer",t);f(this,"texture");let[r,i]=t.size;this.texture=e.createTexture(),e.bindTexture(e.TEXTURE_2D,this.texture),e.texImage2D(e.TEXTURE_2D,0,e.RGBA8,r,i,0,e.RGBA,e.UNSIGNED_BYTE,n[t.pixels]);for(let s of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])e.texParameteri(e.TEXTURE_2D,e[s],t.smooth?e.LINEAR:e.NEAREST);for(let s of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])e.texParameteri(e.TEXTURE_2D,e[s],e.CLAMP_TO_EDGE)}get translucent(){return this.layer.clear||this.layer.opacity<1}release(){this.gl.deleteTexture(this.texture)}draw(e,t){let{layer:n}=this;e.use().set({clip_from_data:Re(R(t.projection,t.view)),corner:n.corner,across:n.across,up:n.up,opacity:n.opacity}),e.ints({clear:n.clear?1:0}).textures({pixels:this.texture}),this.gl.bindVertexArray(null),this.gl.drawArrays(this.gl.TRIANGLE_STRIP,0,4)}};var an=4,Bt=2.5,ln=.999,Ft=[1,2,3].map(o=>(Bt**o-1)/(Bt**an-1)),cn=[-1,1,1];function Ze(o){let e=o.getExtension("EXT_color_buffer_float"),t=e??o.getExtension("EXT_color_buffer_half_float");return e&&o.getExtension("EXT_float_blend")?32:t?16:0}var Pe=class{constructor(e,t,n,r,i){f(this,"gl",e);f(this,"bits",t);f(this,"width",n);f(this,"height",r);f(this,"depths",i);f(this,"held",new Map);f(this,"mixed");f(this,"weights");f(this,"buffer");this.mixed=M(e,e.RGBA16F,n,r),this.weights=M(e,e.R16F,n,r),this.buffer=z(e,this.mixed,i),this.attach([this.weights])}attach(e){let{gl:t}=this;e.forEach((n,r)=>t.framebufferTexture2D(t.FRAMEBUFFER,t.COLOR_ATTACHMENT1+r,t.TEXTURE_2D,n,0)),t.drawBuffers([t.COLOR_ATTACHMENT0,...e.map((n,r)=>t.COLOR_ATTACHMENT1+r)])}begin(e,t,n){let{gl:r,width:i,height:s}=this,a=this.held.get(e);if(a&&!!a.places!==t&&(this.drop(a),a=void 0),!a){let l=M(r,r.RGBA32UI,i,s),c=M(r,r.DEPTH_COMPONENT32F,i,s),u=t?M(r,r.R32UI,i,s):null,h=e.layer.through.all?Ft.concat(1).map(()=>M(r,this.bits===32?r.RGBA32F:r.RGBA16F,i,s)):[],m=z(r,l,c);u&&this.attach([u]);let p=h.length?z(r,h[0],this.depths):m;h.length&&this.attach(h.slice(1)),this.held.set(e,a={texels:l,depths:c,places:u,sums:h,nearest:m,behind:p,summed:!1})}a.summed=!1,r.bindFramebuffer(r.READ_FRAMEBUFFER,n),r.bindFramebuffer(r.DRAW_FRAMEBUFFER,a.nearest),r.blitFramebuffer(0,0,i,s,0,0,i,s,r.DEPTH_BUFFER_BIT,r.NEAREST),r.bindFramebuffer(r.FRAMEBUFFER,a.nearest),r.clearBufferuiv(r.COLOR,0,[k,k,0,0])}nearest(e){this.gl.bindFramebuffer(this.gl.FRAMEBUFFER,this.held.get(e).nearest)}depthsOf(e){return this.held.get(e).depths}behind(e){let{gl:t}=this,n=this.held.get(e);t.bindFramebuffer(t.FRAMEBUFFER,n.behind),n.summed||n.sums.forEach((r,i)=>t.clearBufferfv(t.COLOR,i,[0,0,0,0])),n.summed=!0,t.depthMask(!1),t.enable(t.BLEND),t.blendFunc(t.ONE,t.ONE)}paint(e,t,n){let{texels:r,depths:i,places:s}=this.held.get(t),{layer:a}=t,{through:l}=a,c=R(n.view,t.model),u=new Float64Array(c),h=n.projection,m=t.set.bounds;u.set([0,0,0],12);let p=a.light==="line"?K(u):null,g=p?L(p,cn,0).slice(0,3):[0,0,0],v=Math.hypot(...g)||1,d=-1/0;for(let A=0;A<8;++A)d=Math.max(d,-L(c,[m[A&1],m[2+(A>>1&1)],m[4+(A>>2)]])[2]);e.textures({texels:r,depths:i,places:s}).set({slice_distances:n.parallel?[(h[14]-1)/h[10],2/h[10],1,0]:[h[14],0,1+h[10],-2],slice_far:d,slice_edges:Ft,paint_light:g.map(A=>A/v),paint_opacity:l.opacity,paint_unit:1/Math.max(this.absorbance(t),1e-12),sum_unit:this.unit(t)})}absorbance(e){let{opacity:t,varied:n}=e.layer.through;return n?-Math.log(1-Math.min(t,ln))/255:-Math.log(Math.max(1-t,1e-6))}unit(e){return this.bits===32?1:e.layer.through.varied?2**-16:2**-8}of(e){return this.held.get(e)??null}start(){let{gl:e}=this;e.bindFramebuffer(e.FRAMEBUFFER,this.buffer),e.clearBufferfv(e.COLOR,0,[0,0,0,1]),e.clearBufferfv(e.COLOR,1,[0,0,0,0]),e.depthMask(!1),e.enable(e.BLEND),e.blendFuncSeparate(e.SRC_ALPHA,e.ONE,e.ZERO,e.ONE_MINUS_SRC_ALPHA)}show(e,t,n){let{sums:r,summed:i}=this.held.get(t),s=this.unit(t);e.textures(Object.fromEntries([0,1,2,3].map(a=>[`sums${a}`,i?r[a]:null]))),e.set({opacity:t.layer.through.opacity,absorbance:this.absorbance(t)/s/n,least:i?s/2:1/0})}finish(e,t){let{gl:n}=this;n.bindFramebuffer(n.FRAMEBUFFER,t),n.disable(n.DEPTH_TEST),n.bindVertexArray(null),n.blendFunc(n.SRC_ALPHA,n.ONE_MINUS_SRC_ALPHA),e.textures({mixed:this.mixed,weights:this.weights}),n.drawArrays(n.TRIANGLES,0,3),n.disable(n.BLEND),n.depthMask(!0)}drop(e){let{gl:t}=this;for(let n of[e.texels,e.depths,e.places,...e.sums])t.deleteTexture(n);for(let n of[e.nearest,e.behind])t.deleteFramebuffer(n)}keep(e){for(let[t,n]of this.held)e.includes(t)||(this.drop(n),this.held.delete(t))}release(){this.keep([]);for(let e of[this.mixed,this.weights])this.gl.deleteTexture(e);this.gl.deleteFramebuffer(this.buffer)}};var un=60,hn=45,Tt=400,fn=.5,me=16,Be=4,dn=40,Ct=1065353216,mn=[1,-.8,-.45],pn={none:0,line:1,illuminated:2},Rt=([,o,e,t])=>o===0&&e===0&&t===1,Fe=class{constructor(e,t,n,r){f(this,"canvas",e);f(this,"scene",t);f(this,"data",n);f(this,"archives",r);f(this,"camera");f(this,"lines",[]);f(this,"surfaces",[]);f(this,"images",[]);f(this,"planes",[]);f(this,"width",0);f(this,"height",0);f(this,"ratio",1);f(this,"frames",0);f(this,"few",2e5);f(this,"loading",!1);f(this,"failed",null);f(this,"drawnOnce",null);f(this,"presented",null);f(this,"grown",null);f(this,"finished",null);f(this,"lacking",null);f(this,"gl");f(this,"programs",new Map);f(this,"frameBlock");f(this,"clipBlock");f(this,"raysBlock",null);f(this,"textures",{});f(this,"buffers",{});f(this,"translucent",null);f(this,"bits",null);f(this,"stale",!1);f(this,"frame",null);f(this,"rest",null);f(this,"sync",null);f(this,"sliceStarted",0);f(this,"sliceSize",0);f(this,"rate",1e3);f(this,"dirty",!0);f(this,"moving",!1);f(this,"asked",0);f(this,"still",0);f(this,"waiting",[]);f(this,"looked",null);f(this,"restored",null);this.camera=new Ce(structuredClone(t.camera)),t.camera||this.look();let i=e.getContext("webgl2",{alpha:!1,antialias:!1,depth:!1,preserveDrawingBuffer:!1,powerPreference:"high-performance"});if(!i)throw new ce("This browser has no WebGL 2, which the page draws with. Turn on graphics acceleration in its settings, or open the page in another browser.");this.gl=i,e.addEventListener("webglcontextlost",s=>{s.preventDefault(),this.frame=this.rest=null,this.sync=null}),e.addEventListener("webglcontextrestored",()=>this.guarded(()=>this.begin())),this.begin()}guarded(e){try{e()}catch(t){this.gl.isContextLost()||this.failed?.(t)}}begin(){let{gl:e}=this,t=this.lines.splice(0);this.programs.clear(),this.rest=this.translucent=this.bits=null,this.textures={},this.buffers={},this.width=this.height=0,this.surfaces.length=this.images.length=0,this.frameBlock=new G(e,"Frame"),this.clipBlock=new G(e,"ClipPlanes"),this.raysBlock=null,this.fill(new Map,new Map),t.forEach((n,r)=>{let i=this.lines[r];i.shownValues=n.shownValues,i.marked=n.marked}),this.restored?.(),this.change()}fill(e,t){let{gl:n,scene:r}=this;r.layers.forEach(s=>{s.kind==="surface"?this.surfaces.push(t.get(JSON.stringify(s))??new Se(n,s,this.data)):s.kind==="image"?this.images.push(t.get(JSON.stringify(s))??new Oe(n,s,this.data)):this.lines.push(new Me(n,s,this.lines.length,this.data,this.archives.get(s.data),e.get(this.data[s.data])))});let i=Math.min(1024,128*(navigator.deviceMemory??4))*2**20;for(let s of this.lines)s.set.budget=i/this.lines.length}update(e,t,n){if(this.gl.isContextLost())return;let{data:r}=this,i=this.lines.splice(0),s=this.surfaces.splice(0),a=this.images.splice(0),l=new Map(i.map(u=>[r[u.layer.data],u.set])),c=({layer:u})=>(u.kind==="image"?[u.pixels]:[u.places,u.triangles,u.normals,u.colours,u.values,u.edges?.sides]).every(h=>h===void 0||r[h]===t[h]);this.frame=this.rest=null,this.scene=e,this.data=t,this.archives=n,this.fill(l,new Map([...s,...a].filter(c).map(u=>[JSON.stringify(u.layer),u])));for(let u of i)u.release();for(let u of a)this.images.includes(u)||u.release();for(let{set:u}of i)this.lines.some(h=>h.set===u)||u.release();for(let u of s)this.surfaces.includes(u)||u.release();this.change()}program(e,t,n=[]){let r=[e,t,...n].join(" "),i=this.programs.get(r);return i||this.programs.set(r,i=new ue(this.gl,e,t,n)),i}change(e=!1){this.dirty=!0,this.moving=e,window.clearTimeout(this.still),e&&(this.still=window.setTimeout(()=>this.change(),200)),this.schedule()}grow(){this.guarded(()=>{let e=this.frame??this.rest;if(this.throughs().length){for(let{set:t,layer:n}of this.lines)t.advance(this.archives.get(n.data).ready);this.frame?this.stale=!0:this.change(),this.grown?.();return}for(let t of this.lines){let{set:n}=t,r=n.blocks.length;if(n.advance(this.archives.get(t.layer.data).ready),!e||!t.layer.visible)continue;let i=e.jobs.length;if(this.addJobs(e,t,n.blocks.slice(r)),n.segments(n.blocks.reduce((a,l)=>a+l.items,0))<=this.few)continue;let s=e.jobs.splice(i);for(let a of["likely","others"])e.jobs.push(...s.map(l=>({...l,what:a})))}e?this.dirty||(this.frame=e):this.change(),this.grown?.()}),this.schedule()}throughs(){let e=this.lines.filter(({layer:t})=>t.visible&&t.through);return e.length&&this.bits===null&&!(this.bits=Ze(this.gl))&&this.lacking?.("its graphics cannot add up colours of lines that one looks through"),this.bits===0?[]:e}addJobs(e,t,n){let r=R(e.matrices.projection,R(e.matrices.view,t.model));for(let i of n)this.outside(r,i.bounds)||e.jobs.push({lines:t,block:i,what:"all"})}findFarTiles(e,t,n){let{gl:r}=this,i=Math.ceil(this.width/Be),s=Math.ceil(this.height/Be);if(r.bindFramebuffer(r.FRAMEBUFFER,this.buffers.far),!t)return r.clearBufferuiv(r.COLOR,0,[Ct,0,0,0]),null;if(r.disable(r.DEPTH_TEST),r.bindVertexArray(null),r.viewport(0,0,i,s),this.program("page/screen.vert","page/far_tiles.frag").use().textures({depths:e}),r.drawArrays(r.TRIANGLES,0,3),r.viewport(0,0,this.width,this.height),!n)return null;let a=new Uint32Array(4*i*s);return r.readPixels(0,0,i,s,r.RGBA_INTEGER,r.UNSIGNED_INT,a),Rt(a)||a.fill(Ct),{size:Be,columns:i,rows:s,depths:new Float32Array(a.buffer)}}schedule(){let e=()=>this.guarded(()=>this.tick());this.asked||(this.asked=this.sync&&this.frame&&!this.frame.moving?window.setTimeout(e,1):requestAnimationFrame(e))}settled(){return!this.dirty&&!this.frame&&!this.moving&&!this.loading?Promise.resolve():new Promise(e=>this.waiting.push(e))}tick(){this.asked=0;let{gl:e}=this;if(e.isContextLost())return;if(this.sync){if(e.getSyncParameter(this.sync,e.SYNC_STATUS)!==e.SIGNALED)return this.schedule();e.deleteSync(this.sync),this.sync=null;let i=Math.max(performance.now()-this.sliceStarted,.5);this.sliceSize>2e3&&(this.rate+=.5*(Math.min(this.sliceSize/i,8*this.rate)-this.rate))}this.fit(),this.dirty&&this.start();let t=this.frame;if(!t)return;let n=this.rate*un;this.sliceStarted=performance.now(),this.sliceSize=0;do this.drawSlice(t,t.moving?1/0:n);while(t.next<t.jobs.length&&(t.moving||this.sliceSize<n&&t.jobs[t.next].what!=="others"));let r=t.next>=t.jobs.length;(r||this.worthShowing(t))&&(t.shownAt=performance.now(),this.present(t,r),this.drawnOnce&&(t.jobs.length||!this.loading)&&(this.drawnOnce(),this.drawnOnce=null)),this.sync=e.fenceSync(e.SYNC_GPU_COMMANDS_COMPLETE,0),e.flush(),r&&(this.frame=null,this.rest=t.moving?null:t,++this.frames,this.stale&&this.change(),t.moving||this.finished?.(),!t.moving&&!this.dirty&&!this.loading&&this.waiting.splice(0).forEach(i=>i())),this.schedule()}worthShowing({jobs:e,next:t,begun:n,shownAt:r}){let i=performance.now(),{what:s}=e[t],a=c=>c.what===s,l=(i-n)*e.slice(t).filter(a).length/Math.max(e.slice(0,t).filter(a).length,1);return i-r>Math.max(Tt,fn*(r-n))&&(!this.frames||l>Tt)}look(e=mn,t=[0,0,1]){let{camera:n,canvas:r}=this;n.lookAlong(e,t,this.scene.bounds,r.clientWidth/r.clientHeight||1),this.looked={direction:e,up:t,state:JSON.stringify(n.state)}}fit(){let{gl:e,canvas:t}=this,n=window.devicePixelRatio||1,r=e.getParameter(e.MAX_TEXTURE_SIZE)-2,i=Math.min(r,Math.max(1,Math.round(t.clientWidth*n))),s=Math.min(r,Math.max(1,Math.round(t.clientHeight*n)));if(i===this.width&&s===this.height)return;t.width=this.width=i,t.height=this.height=s,this.ratio=n,this.looked?.state===JSON.stringify(this.camera.state)&&this.look(this.looked.direction,this.looked.up);for(let l of Object.values(this.textures))e.deleteTexture(l);for(let l of Object.values(this.buffers))e.deleteFramebuffer(l);this.translucent?.release(),this.translucent=null;let a=this.textures={texels:M(e,e.RGBA32UI,i,s),depths:M(e,e.DEPTH_COMPONENT32F,i,s),drawn:M(e,e.RGBA8,i,s),shown:M(e,e.RGBA32UI,i+2,s+2),tiles:M(e,e.R8UI,Math.ceil(i/me),Math.ceil(s/me)),far:M(e,e.R32UI,Math.ceil(i/Be),Math.ceil(s/Be))};this.buffers={texels:z(e,a.texels,a.depths),scene:z(e,a.drawn,a.depths),drawn:z(e,a.drawn,null),shown:z(e,a.shown,null),tiles:z(e,a.tiles,null),far:z(e,a.far,null)},this.dirty=!0}start(){let{gl:e,camera:t,scene:n}=this,r=this.moving;this.dirty=!1;let i=t.view(),s=t.projection(this.width/this.height,n.bounds),a={view:i,projection:s,parallel:t.state.parallel,lights:d=>this.setLights(d,i),planes:this.planes,ratio:this.ratio},l=this.frame={jobs:[],next:0,share:1,drawn:0,begun:performance.now(),shownAt:performance.now(),matrices:a,moving:r,through:new Set};this.rest=null,this.stale=!1;let c=this.throughs(),u=this.lines.filter(({layer:d})=>d.visible),h=(d,A)=>d.reduce((b,x)=>b+x.lines.set.segments(A(x)),0),m=d=>{l.jobs=[];for(let A of d)this.addJobs(l,A,A.set.blocks);return l.jobs},p=h(m(u),({block:d})=>d.items)>this.few,g=d=>{if(!p)return d;let A=({lines:F,block:{bounds:w}})=>L(R(i,F.model),[w[0]+w[1],w[2]+w[3],w[4]+w[5]].map(E=>E/2))[2],b=new Map(d.map(F=>[F,A(F)])),x=d.sort((F,w)=>b.get(w)-b.get(F)).map(F=>({...F,what:"likely"}));return r?x:[...x,...x.map(F=>({...F,what:"others"}))]},v=g(m(u.filter(d=>!c.includes(d))));for(let d of c){let A=m([d]);v.push(...g([...A])),d.layer.through.all&&v.push(...A.map(b=>({...b,what:"behind"})))}l.jobs=v,r&&(l.share=Math.min(1,this.rate*hn/Math.max(h(v,({lines:d,block:A,what:b})=>b==="likely"?(d.set.likely(A),A.likelies):A.items),1))),this.mixes()?(this.translucent??(this.translucent=new Pe(e,this.bits,this.width,this.height,this.textures.depths))).keep(c):(this.translucent?.release(),this.translucent=null),this.frames||(l.shownAt=0),e.viewport(0,0,this.width,this.height),e.disable(e.BLEND),e.disable(e.CULL_FACE),e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.texels),e.clearBufferuiv(e.COLOR,0,[k,k,0,0]),e.depthMask(!0),e.clearBufferfv(e.DEPTH,0,[1]),this.drawBackdrop(a)}drawBackdrop(e){let{gl:t,scene:n}=this;t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.scene),t.disable(t.DEPTH_TEST),t.bindVertexArray(null),this.program("page/screen.vert","page/background.frag").use().set({bottom:n.background[0],top:n.background[1],height:this.height}),t.drawArrays(t.TRIANGLES,0,3),t.enable(t.DEPTH_TEST),t.depthFunc(t.LEQUAL),t.depthMask(!0);for(let i of this.surfaces)i.layer.visible&&!i.translucent&&i.draw(this.surfaceProgram(i),e);let r=this.program("page/image.vert","page/image.frag");for(let i of this.images)i.layer.visible&&!i.translucent&&i.draw(r,e)}surfaceProgram({layer:e}){return this.program("page/surface.vert","page/surface.frag",e.log?["TABLE_LOGARITHM"]:[])}outside(e,t){let n=[0,0,0,0,0,0];for(let r=0;r<8;++r){let[i,s,a,l]=L(e,[t[r&1],t[2+(r>>1&1)],t[4+(r>>2)]]);[i<-l,i>l,s<-l,s>l,a<-l,a>l].forEach((c,u)=>n[u]+=c?1:0)}return n.some(r=>r===8)}setLights(e,t){let n=[0,0,0],r=0;this.scene.lights.slice(0,8).forEach((i,s)=>{let a=[0,0,1,0];i.view?a=[...i.view,0]:i.world&&(r=1,a=L(t,i.world,i.positional?1:0),a[3]=i.positional?1:0),e.set({[`light_colour[${s}]`]:i.colour,[`light_place[${s}]`]:a}),i.colour.forEach((l,c)=>n[c]+=l)}),e.ints({light_count:Math.min(this.scene.lights.length,8)}).set({light_sum:n,light_standing:r})}aim(e,t){let n=e.layer.line_width*this.ratio,r=this.wide(e),i=R(t.view,R(e.model,e.set.toData)),s=R(t.projection,i),a=s.reduce((u,h)=>Math.max(u,Math.abs(h)),0)||1,l=new Float64Array(16);for(let u=0;u<4;++u){let[h,m,p,g]=[0,1,2,3].map(v=>s[v+4*u]/a);l.set([this.width/2*(h+g),this.height/2*(m+g),(p+g)/2,g],4*u)}this.frameBlock.write({window_from_local:l,reference:e.set.reference,half_line_width:r?n/2:0,viewport:[this.width,this.height]},["reference"]),this.frameBlock.bind();let c=[...e.layer.planes??[],...this.planes].slice(0,8);if(c.length){let u=R(e.model,e.set.toData),h=K(s),m=new Float64Array(32),p=new Float64Array(32);c.forEach((g,v)=>{let d=[0,1,2,3].map(b=>g[0]*u[4*b]+g[1]*u[4*b+1]+g[2]*u[4*b+2]+g[3]*u[4*b+3]),A=Math.hypot(d[0],d[1],d[2])||1;if(d.forEach((b,x)=>m[4*v+x]=b/A),h)for(let b=0;b<2;++b){let x=[0,1,2,3].reduce((F,w)=>F+m[4*v+w]*h[w+4*b],0);p[4*v+b]=x*a*(2/(b===0?this.width:this.height))}}),this.clipBlock.write({clip_planes:m,clip_tilts:p,clip_plane_count:0,clip_rounding:0}),this.clipBlock.write({clip_plane_count:c.length},["clip_plane_count"]),this.clipBlock.bind()}return{wide:r,clipped:c.length>0,window:l}}cut(e,t){let{width:n,height:r}=this,i=new Float64Array([n/2,0,0,0,0,r/2,0,0,0,0,.5,0,n/2,r/2,.5,1]),s=Et(e,R(i,R(t.projection,t.view)),n,r);return s?((this.raysBlock??(this.raysBlock=new G(this.gl,"Rays"))).write(s),this.raysBlock.bind(),!0):!1}pixelsOf(e,t,n){let r=R(t.projection,R(t.view,e.model)),i=e.set.bounds,s=Math.hypot(...we(e.model)),a=1/0;for(let l=0;l<8;++l)a=Math.min(a,L(r,[i[l&1],i[2+(l>>1&1)],i[4+(l>>2)]])[3]);return a>0?n*s*(this.height/2)*t.projection[5]/a:1/0}drawSlice(e,t){let{gl:n}=this,r=null,i=null,s=!1,a=be(),l=1,c=e.jobs[e.next],u=c&&this.phase(c),h=c?.what==="behind",m=u?this.translucent:null;m&&!e.through.has(c.lines)&&(e.through.add(c.lines),m.begin(c.lines,this.wide(c.lines)&&c.lines.layer.through.all,this.buffers.texels));let p=c?.what==="others",g=m&&!h?m.depthsOf(c.lines):this.textures.depths,v=this.findFarTiles(g,e.next>0,p);for(;e.next<e.jobs.length&&this.sliceSize<t;){let{lines:d,block:A,what:b}=e.jobs[e.next];if(this.phase(e.jobs[e.next])!==u||b==="others"!==p&&this.sliceSize)break;if(++e.next,d.set.pointsOf(A),r!==d){r=d;let F=this.aim(d,e.matrices),{wide:w,clipped:E}=F;a=F.window,l=1+(w?d.layer.line_width*this.ratio/2:0);let B=["CLIPPING","CLIPPING_DEPTH","EDGES"];w&&B.push("WIDE_LINES"),d.layer.ends&&B.push("LINE_ENDS"),E&&B.push("CLIP_PLANES"),d.layer.cut&&this.cut(d.layer.cut,e.matrices)&&B.push("CLIP_REGION",`REGION ${xt(d.layer.cut)}`),s=!w&&this.pixelsOf(d,e.matrices,d.set.longestStep)<=dn,s&&B.push("SPRITES"),d.values&&B.push("VALUES_STORED"),d.byPoint&&B.push("VALUES_COLOUR"),d.kept&&B.push("STREAMLINE_MASK"),d.keptPoints&&B.push("POINT_MASK"),w&&m&&d.layer.through.all&&B.push("GATHER_SLICES"),h&&B.push(...d.colouring),i=this.program("page/segment.vert",h?"page/sum.frag":"page/segment.frag",B).use(),d.values&&i.set({shown_values:d.shownValues.map(C=>C-d.values.reference)}),i.uints({layer:d.index*2**28})}let x=b==="others"&&v?d.set.look(A,a,l,this.width,this.height,v):d.set.likely(A);h?m.behind(d):m?m.nearest(d):n.bindFramebuffer(n.FRAMEBUFFER,this.buffers.texels),n.enable(n.DEPTH_TEST),n.depthFunc(m?n.LEQUAL:n.LESS),this.frameBlock.bind(),h&&(this.colour(i.use(),d),m.paint(i,d,e.matrices)),i.use().textures({far_tiles:this.textures.far,items:d.set.items,kept:d.kept,kept_points:d.keptPoints,value_texels:d.values&&d.values.texture,value_table:d.values&&d.values.table,point_colours:d.byPoint?d.colours:null}),b==="all"||h?this.sliceSize+=d.set.draw(A,i,e.share*A.items,s):this.sliceSize+=A.items+d.set.drawSome(A,i,x,s,Math.ceil(e.share*(b==="likely"?A.likelies:A.items)))}n.disable(n.BLEND),n.depthMask(!0)}phase({lines:e,what:t}){return e.layer.through&&this.bits?`${e.index} ${t==="behind"}`:""}wide(e){return e.layer.ends||e.layer.line_width*this.ratio>1}colour(e,t){let{colours:n,through:r}=t.layer,{texels:i}=this.textures;e.textures({colour_list:t.byPoint?null:t.colours,colour_table:t.table,opacities:t.opacities??i}),e.ints({colour_entries:t.tableSize,by_streamline:t.opacities?1:0,by_point:r?.by_point?1:0}),e.set({colour_solid:n.colour??[1,1,1],colour_range:t.tableRange,colour_reference:0})}light(e,t,n,r,i){let{layer:s}=t,a=K(n.projection)??be();this.colour(e,t),e.textures({texels:r,depths:i,chosen:t.chosen??r}).uints({layer:t.index*2**28,marked:t.marked}),e.ints({light:pn[s.light]}).set({reflects:s.reflects,sheen:s.sheen,chosen_colour:s.chosen?.colour??[0,0,0,0],faded:s.chosen?.faded??[0,0,0,0],data_to_view:we(R(n.view,t.model)),pixel_to_view:new Float32Array(a),picture:[this.width,this.height]}),this.setLights(e,n.view)}present(e,t){let{gl:n,textures:r,buffers:i}=this,s=e.matrices,a=[...e.through];this.repaint(s),n.disable(n.DEPTH_TEST),n.bindVertexArray(null),this.findTiles(a),n.bindFramebuffer(n.FRAMEBUFFER,i.drawn);for(let l of this.lines){if(!l.layer.visible||e.through.has(l))continue;let c=this.program("page/tiles.vert","page/resolve.frag",l.colouring).use();this.light(c,l,s,r.texels,r.depths),this.drawTiles(c)}if(this.drawTranslucent(e),n.disable(n.DEPTH_TEST),n.bindVertexArray(null),t&&this.scene.antialias&&this.lines.length){let l=h=>Math.max(0,...h.map(({layer:m})=>1-Math.min(1,m.visible?m.line_width*this.ratio:1)));n.bindFramebuffer(n.FRAMEBUFFER,i.shown),n.viewport(0,0,this.width+2,this.height+2);let c=this.program("page/screen.vert","page/visible_edges.frag").use().textures({texels:r.texels,depths:r.depths,drawn:r.drawn});c.ints({first:1}).set({narrower:l(this.lines.filter(h=>!e.through.has(h)))}),n.drawArrays(n.TRIANGLES,0,3);for(let h of a){let{texels:m,depths:p}=this.translucent.of(h);c.textures({texels:m,depths:p}).ints({first:0}).set({narrower:l([h])}),n.drawArrays(n.TRIANGLES,0,3)}n.viewport(0,0,this.width,this.height),n.bindFramebuffer(n.FRAMEBUFFER,i.drawn);let u=this.program("page/tiles.vert","effects/picture/antialias_coverage.frag").use().textures({shown:r.shown});n.uniform2i(u.at("shift"),1,1),this.drawTiles(u)}n.bindFramebuffer(n.FRAMEBUFFER,null),this.program("page/screen.vert","page/copy.frag").use().textures({drawn:r.drawn}),n.drawArrays(n.TRIANGLES,0,3),this.presented?.()}findTiles(e){let{gl:t,textures:n}=this;t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.tiles),t.viewport(0,0,Math.ceil(this.width/me),Math.ceil(this.height/me));let r=this.program("page/screen.vert","page/tile_mask.frag").use();[n.texels,...e.map(i=>this.translucent.of(i).texels)].forEach((i,s)=>{r.textures({texels:i}).ints({first:s?0:1}),t.drawArrays(t.TRIANGLES,0,3)}),t.viewport(0,0,this.width,this.height)}drawTiles(e){let{gl:t}=this;e.textures({tiles:this.textures.tiles}).set({whole:[this.width,this.height]}),t.drawArraysInstanced(t.TRIANGLE_STRIP,0,4,Math.ceil(this.width/me)*Math.ceil(this.height/me))}repaint(e){this.frame&&this.frame.drawn++>0&&this.drawBackdrop(e)}mixes(){return!!(this.throughs().length||[...this.surfaces,...this.images].some(({layer:t,translucent:n})=>t.visible&&n))&&!!(this.bits??(this.bits=Ze(this.gl)))}drawTranslucent(e){let{gl:t,translucent:n}=this,r=e.matrices,i=this.surfaces.filter(a=>a.layer.visible&&a.translucent),s=this.images.filter(a=>a.layer.visible&&a.translucent);if(!(!i.length&&!s.length&&!e.through.size)){n?n.start():(t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.scene),t.depthMask(!1),t.enable(t.BLEND),t.blendFunc(t.SRC_ALPHA,t.ONE_MINUS_SRC_ALPHA));for(let a of e.through){let l=this.program("page/tiles.vert","page/through.frag",a.colouring).use(),{texels:c,depths:u}=n.of(a);this.light(l,a,r,c,u),n.show(l,a,e.share),this.drawTiles(l)}t.enable(t.DEPTH_TEST),t.depthFunc(t.LEQUAL),i.sort((a,l)=>l.depth(r.view)-a.depth(r.view));for(let a of i)a.draw(this.surfaceProgram(a),r);if(s.length){let a=this.program("page/image.vert","page/image.frag");s.forEach(l=>l.draw(a,r))}n&&n.finish(this.program("page/screen.vert","page/mixed.frag").use(),this.buffers.drawn),t.disable(t.BLEND),t.depthMask(!0)}}reads(){let{gl:e}=this,t=new Uint32Array(4);return e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.far),e.readPixels(0,0,1,1,e.RGBA_INTEGER,e.UNSIGNED_INT,t),Rt(t)}pick(e,t){let{gl:n}=this,r=Math.floor(e*this.ratio),i=this.height-1-Math.floor(t*this.ratio),s=new Uint32Array(4),a=[[0,0],[1,0],[-1,0],[0,1],[0,-1],[2,0],[-2,0],[0,2],[0,-2]];for(let[l,c]of a){if(r+l<0||i+c<0||r+l>=this.width||i+c>=this.height)continue;for(let m of[...this.throughs().map(p=>this.translucent?.of(p)?.nearest),this.buffers.texels])if(m&&(n.bindFramebuffer(n.FRAMEBUFFER,m),n.readPixels(r+l,i+c,1,1,n.RGBA_INTEGER,n.UNSIGNED_INT,s),s[0]!==k||s[1]!==k))break;if(s[0]===k&&s[1]===k)continue;let u=this.lines[s[0]>>>28];if(!u)continue;let h=u.values?new Float32Array(new Uint32Array([s[3]]).buffer)[0]:null;return{lines:u,streamline:s[0]&268435455,value:h}}return null}placeOf(e,t,n,r){let{camera:i,scene:s,canvas:a}=this,l=a.clientWidth,c=a.clientHeight,u=R(i.projection(this.width/this.height,s.bounds),R(i.view(),e.model)),h=[0,0,0],m=1/0;for(let p of e.set.pointsOfStreamline(t)){let[g,v,,d]=L(u,p),A=Math.hypot((g/d+1)*l/2-n,(1-v/d)*c/2-r);d>0&&A<m&&([h,m]=[p,A])}return h}pixels(){let{gl:e,width:t,height:n}=this,r=new Uint8Array(4*t*n),i=new Uint8Array(r.length);e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.drawn),e.readPixels(0,0,t,n,e.RGBA,e.UNSIGNED_BYTE,r);for(let s=0;s<n;++s)i.set(r.subarray(4*t*s,4*t*(s+1)),4*t*(n-1-s));return i}};var Dt=o=>document.getElementById(o)?.textContent??"",pe=4;async function An(o){let e=new Set(o.layers.map(t=>t.kind==="fiblets"?t.data:-1));return Promise.all(o.data.map(async(t,n)=>{if(t.file===void 0)return Y(Dt(`data-${n}`).trim());if(e.has(n))return new Uint8Array;let r=new Ee(t.file,t.bytes);return await r.need(0,t.bytes),r.bytes}))}async function gn(o,e,t){let n=new Map;return await Promise.all(o.layers.map(async r=>{if(r.kind!=="fiblets")return;let{file:i,bytes:s}=o.data[r.data];if(i===void 0){n.set(r.data,await at(Ne(e[r.data])));return}let a=new Ee(i,s),l=r.colours.values===void 0?[]:[r.colours.values],c=await st(a,l);n.set(r.data,c),t.push({archive:c,remote:a,values:l})})),n}async function vn(o,e){let t=document.createElement("progress"),n=1<<ae;t.setAttribute("aria-label","Streamlines that have come"),t.max=o.reduce((r,{archive:i})=>r+i.header.n_fiblets,0),document.getElementById("over").append(t),await Promise.all(o.map(async({archive:r,remote:i,values:s})=>{let a=r.header.n_fiblets,l=Math.ceil(a/n),c=h=>ot(i,r,h,Math.min(h+pe,l),n,s),u=c(0);for(let h=0;h<l;h+=pe){let m=u;h+pe<l&&(u=c(h+pe)).catch(()=>{}),await m,t.value+=Math.min((h+pe)*n,a)-r.ready,r.ready=Math.min((h+pe)*n,a),e.grow()}})),t.remove()}function _t(o){let e=document.getElementById("message");e.textContent=o instanceof Error?o.message:String(o),e.hidden=!1,document.body.dataset.state="failed"}async function bn(){let o=JSON.parse(Dt("scene"));document.title=o.title;let e=await An(o),t=[],n=await gn(o,e,t),r=new Fe(document.getElementById("view"),o,e,n);r.loading=t.length>0,r.failed=_t,r.lacking=s=>{document.getElementById("status").textContent=`This browser draws translucent lines opaque: ${s}.`},r.drawnOnce=()=>{document.body.dataset.state="drawn"},new ResizeObserver(()=>r.change()).observe(r.canvas);let i=new ke(r,e);if(We(r,(s,a)=>i.pick(s,a)),yt(r,i),window.pvfiblets=r,!!t.length)try{await vn(t,r)}finally{r.loading=!1,r.grow()}}window.pvfibletsPage={Renderer:Fe,attachMouse:We,readArchive:Ne};document.getElementById("scene")&&bn().catch(_t);})();
