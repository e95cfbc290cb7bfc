// Built by `make client` of sources 274f314a157bd5ca
"use strict";(()=>{var Pe=Object.defineProperty;var Oe=(o,e,n)=>e in o?Pe(o,e,{enumerable:!0,configurable:!0,writable:!0,value:n}):o[e]=n;var l=(o,e,n)=>Oe(o,typeof e!="symbol"?e+"":e,n);var O={blocks:{ClipPlanes:{bytes:400,fields:{clip_brushes:256,clip_plane_count:384,clip_planes:0,clip_rounding:388,clip_tilts:128}},Coding:{bytes:96,fields:{anchor_scale:0,end_vector_scale:28,lattice_edge:24,radius_scale:12,rotation_scales:32,step_low:16,step_span:20}},Frame:{bytes:208,fields:{half_line_width:172,line_reach:184,most_pixels_per_mm:192,plane_rounding:188,reference:160,segment_deviation:200,segment_size:204,view_planes:64,viewport:176,w_per_mm:196,window_from_local:0}},Rotations:{bytes:16384,fields:{rotations:0}}},fields:{anchor_x:[0,0,16],anchor_y:[0,16,16],anchor_z:[1,0,16],begin:[1,30,1],cap:[2,26,4],code:[1,0,22],end:[1,31,1],kind:[2,30,2],last:[2,20,6],point:[2,0,20],rank:[1,16,14],shape:[0,0,32],step:[1,22,10]},page_bits:14,rotation_scales:[39380907423947065e-23,5413425014921813e-22,7445069627465273e-22,1023472805172787e-21,14070004681343562e-22,19338988295203308e-22,2657444838405354e-21,3649580548881204e-21,5006992068956606e-21,6855771061964333e-21,9352394044981338e-21,1266809158551041e-20,1692779733275529e-20,22030990294297226e-21,27206533559365198e-21,300810752378311e-19],rotations:"AAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbRuK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6nLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420biuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07Svlg==",shaders:{"effects/picture/antialias_coverage.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
const float EDGE_STEPS=448.0;
const float EDGE_LEAST=2.0;
const float WIDTH_STEPS=32.0;
uint packed_edges(vec2 n,float e,float w,uint end){
vec2 q=n/max(abs(n.x)+ abs(n.y),1e-30);
int turn=int((q.y>=0.0?1.0 - q.x:3.0 + q.x)*512.0 + 0.5)&2047;
int inside=int(clamp((e + EDGE_LEAST)*EDGE_STEPS + 0.5,0.0,2047.0));
int across=int(clamp(w*WIDTH_STEPS + 0.5,1.0,127.0));
return uint(turn|(inside<<11)|(across<<22))|(end<<29u);
}
struct Edges{
vec2 n;
float e;
float w;
uint end;
float stop;
};
Edges unpacked_edges(uint word){
float turn=float(int(word&2047u))/512.0,x=abs(turn - 2.0)- 1.0;
int width=int((word>>22u)&127u),end=int(word>>29u);
return Edges(normalize(vec2(x,turn<2.0?1.0 - abs(x):abs(x)- 1.0)),
float(int((word>>11u)&2047u))/EDGE_STEPS - EDGE_LEAST,width==127?128.0:float(width)/WIDTH_STEPS,
uint(end),float(end>3?end - 5:end - 2)/3.0);
}
uniform usampler2D shown;
uniform ivec2 shift;
out vec4 colour;
const vec4 X0=vec4(1.5,2.5,5.5,6.5),X1=vec4(-2.5,-1.5,-5.5,-7.5);
const vec4 Y0=vec4(1.5,5.5,3.5,7.5),Y1=vec4(2.5,6.5,4.5,0.5);
const vec4 X2=vec4(4.5,3.5,0.5,7.5),X3=vec4(-0.5,-4.5,-3.5,-6.5);
const vec4 Y2=vec4(-0.5,-4.5,-6.5,-3.5),Y3=vec4(-2.5,-1.5,-5.5,-7.5);
const uint EVERY=0x01010101u,SAMPLE=12u,PIXEL=16u*SAMPLE;
const int OWN=4;
struct Band{
vec2 n;
float away;
float size;
};
uint bits(bvec4 inside){
return(inside.x?1u:0u)|(inside.y?0x100u:0u)|(inside.z?0x10000u:0u)|(inside.w?0x1000000u:0u);
}
uint count(uint samples){return(samples*EVERY)>>24u;}
Band band_of(Edges edges,vec2 at,bool there){
float along=edges.n.x*at.y - edges.n.y*at.x;
bool beyond=edges.end==7u||edges.end!=0u&&(edges.end<4u)==(along>edges.stop);
return Band(edges.n/16.0,dot(edges.n,at)- edges.e + 0.5*edges.w,there&&!beyond?0.5*edges.w:-1.0);
}
uint covered(Band band,vec4 x,vec4 y){
return bits(lessThanEqual(abs(band.n.x*x + band.n.y*y + band.away),vec4(band.size)));
}
uint within(Edges edges,vec4 x,vec4 y){
vec4 along=(edges.n.x*y - edges.n.y*x)/16.0;
vec2 range=edges.end==7u?vec2(-0.5,0.5)
:vec2(edges.end<4u?-1.0:edges.stop,edges.end>0u&&edges.end<4u?edges.stop:1.0);
return bits(lessThanEqual(abs(along - 0.5*(range.x + range.y)),vec4(0.5*(range.y - range.x))));
}
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
void main(){
ivec2 pixel=ivec2(gl_FragCoord.xy)+ shift;
NINE(FETCH)
if(((around[0].y|around[1].y|around[2].y)|(around[3].y|around[4].y|around[5].y)
|(around[6].y|around[7].y|around[8].y))==0u)discard;
Edges own=unpacked_edges(around[OWN].y);
bool line=around[OWN].y!=0u;
EIGHT(BEGIN)
bands[OWN]=Band(own.n/16.0,0.5*own.w - own.e,line?0.5*own.w:-1.0);
visible[OWN]=shares[OWN]=0u;
uint depth=around[OWN].x,of_own=around[OWN].z;
if(!line){ADOPT(1)ADOPT(3)ADOPT(5)ADOPT(7)}
QUARTER(X0,Y0,5,7,8)
QUARTER(X1,Y1,3,7,6)
QUARTER(X2,Y2,5,1,2)
QUARTER(X3,Y3,3,1,0)
EIGHT(SHARE)
uint mine=SAMPLE*count(visible[OWN]);
if(shares[OWN] +(line?mine:0u)==PIXEL)discard;
uint red_blue=mine*(of_own&0xFF00FFu),green_alpha=mine*((of_own>>8u)&0xFF00FFu);
NINE(ADD)
colour=vec4(red_blue&0xFFFFu,green_alpha&0xFFFFu,red_blue>>16u,green_alpha>>16u)/(255.0*float(PIXEL));
}
`,"page/background.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
uniform vec3 bottom;
uniform vec3 top;
uniform float height;
layout(location=0)out vec4 colour;
void main(){colour=vec4(mix(bottom,top,gl_FragCoord.y/height),1.0);}
`,"page/copy.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
uniform highp sampler2D drawn;
layout(location=0)out vec4 colour;
void main(){colour=vec4(texelFetch(drawn,ivec2(gl_FragCoord.xy),0).rgb,1.0);}
`,"page/decode.vert":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define FEATURE_ANCHORS_LOW 1
#define FEATURE_DIRECTION 1
#define FEATURE_LATTICE 1
#define FEATURE_POINT_MASK 0
#define FEATURE_RANK_TO_ID 0
#define FEATURE_TUBES 0
#define FEATURE_WIDE_LATTICE 1
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
const uint FIBLET_MAX_POINTS=60u;
const uint FIBLET_PAGE_BITS=14u;
const uint FIBLET_CAPS=16u;
const float FIBLET_DIRECTION_SCALE=32767.0;
const float FIBLET_STEP_LEVELS=1023.0;
const uint FIBLET_WIDE_HEADER=20u;
const uint FIBLET_PLAIN_BYTES=12u;
const uint FIBLET_ANCHORS_WORDS=2u;
const uint FIBLET_DECODING_WORDS=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_LATTICE8=1u;
const uint KIND_LATTICE16=2u;
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
uint fiblet_point(uvec3 words){return bitfieldExtract(words.z,0,20);}
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
#if FEATURE_TUBES
#endif
layout(std140)uniform Coding{
vec3 anchor_scale;
float radius_scale;
float step_low;
float step_span;
float lattice_edge;
float end_vector_scale;
vec4 rotation_scales[4];
};
layout(std140)uniform Rotations{
uvec4 rotations[1024];
};
const int ROW_BITS=12;
const uint chunk_first_rank=0u,chunk_pages=0u;
uniform highp usampler2D anchor_texels;
uniform highp usampler2D page_texels;
uniform highp usampler2D decoding_texels;
uniform highp usampler2D code_texels;
uniform uint chunk_fiblets;
ivec2 texel(uint index){return ivec2(int(index&((1u<<uint(ROW_BITS))- 1u)),int(index>>uint(ROW_BITS)));}
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
#if FEATURE_RANK_TO_ID
uint id_of_rank(uint rank){
uint index=rank - chunk_first_rank;
return page_words(chunk_pages +(index>>2))[index&3u];
}
#endif
#if FEATURE_ANCHORS_LOW
uint anchor_low(uint index){return bitfieldExtract(anchor_low_word(index>>1),int(index&1u)*16,16);}
#endif
float difference(uint a,uint b){return a>=b?float(a - b):-float(b - a);}
vec3 anchor_local(uint f){
uvec2 words=anchor_words(f);
uvec3 q=uvec3(fiblet_anchor_x(words),fiblet_anchor_y(words),fiblet_anchor_z(words));
#if FEATURE_ANCHORS_LOW
q=(q<<16u)|uvec3(anchor_low(3u*f),anchor_low(3u*f + 1u),anchor_low(3u*f + 2u));
vec3 d=vec3(difference(q.x,reference.x),difference(q.y,reference.y),difference(q.z,reference.z));
#else
vec3 d=vec3(ivec3(q)- ivec3(reference));
#endif
precise vec3 p=d*anchor_scale;
return p;
}
bool begins(uint f){return fiblet_begin(anchor_words(f))!=0u;}
bool ends(uint f){return fiblet_end(anchor_words(f))!=0u;}
uint rank_of(uint f){return page_words(f>>FIBLET_PAGE_BITS).x + fiblet_rank(anchor_words(f));}
uvec3 decoding_words(uint f){
uint at=FIBLET_DECODING_WORDS*f;
return uvec3(decoding_word(at),decoding_word(at + 1u),decoding_word(at + 2u));
}
uint first_code(uint f,uvec3 words){return page_words(f>>FIBLET_PAGE_BITS).y + fiblet_code(words);}
uint code_at(uint byte){return bitfieldExtract(code_word(byte>>2),int(byte&3u)*8,8);}
uint codes_at(uint byte){
uint word=byte>>2,shift=(byte&3u)*8u;
uint low=code_word(word);
return shift==0u?low:(low>>shift)|(code_word(word + 1u)<<(32u - shift));
}
float rotation_scale(uint cap){return rotation_scales[cap>>2][cap&3u];}
vec4 rotation(uint cap,uint code,float scale){
int word=int(rotation_word((cap<<8u)+ code));
precise vec2 t=scale*vec2(bitfieldExtract(word,0,16),bitfieldExtract(word,16,16));
precise float w=sqrt(1.0 - t.x*t.x - t.y*t.y);
return vec4(0.0,t,w);
}
float sign_of(int value){return value<0?-1.0:1.0;}
float step_length(uvec3 words){return step_low + float(fiblet_step(words))*(step_span/FIBLET_STEP_LEVELS);}
vec4 first_frame(uint shape){
int u=bitfieldExtract(int(shape),0,16),v=bitfieldExtract(int(shape),16,16);
bool forward=abs(u)+ abs(v)<=int(FIBLET_DIRECTION_SCALE);
precise vec2 s=vec2(float(u),float(v))/FIBLET_DIRECTION_SCALE;
precise float x=1.0 - abs(s.x)- abs(s.y);
precise vec3 d=forward?vec3(x,s)
:vec3(x,(1.0 - abs(s.y))*sign_of(u),(1.0 - abs(s.x))*sign_of(v));
d=d/sqrt(dot(d,d));
precise vec3 h=forward?vec3(1.0 + d.x,-d.z,d.y):vec3(1.0 - d.x,d.z,-d.y);
h=h/sqrt(dot(h,h));
return forward?vec4(0.0,h.y,h.z,h.x):vec4(h.y,0.0,h.x,-h.z);
}
vec3 rotated_x(vec4 q){
precise vec3 d=vec3(1.0 - 2.0*(q.y*q.y + q.z*q.z),2.0*(q.x*q.y + q.w*q.z),2.0*(q.x*q.z - q.w*q.y));
return d;
}
vec4 turned(vec4 a,vec4 t){
precise vec4 q=vec4(a.x*t.w + a.y*t.z - a.z*t.y,a.w*t.y - a.x*t.z + a.y*t.w,
a.w*t.z + a.x*t.y + a.z*t.w,a.w*t.w - a.y*t.y - a.z*t.z);
return q;
}
#if FEATURE_LATTICE
void lattice_box(uvec3 words,inout uint byte,out ivec3 lo,out uvec2 n,out uint width){
int shape=int(fiblet_shape(words));
lo=ivec3(bitfieldExtract(shape,0,8),bitfieldExtract(shape,8,8),bitfieldExtract(shape,16,8));
n=uvec2((uint(shape)>>24u)+ 1u,(fiblet_step(words)&255u)+ 1u);
width=fiblet_kind(words);
#if FEATURE_WIDE_LATTICE
if(fiblet_kind(words)==KIND_WIDE&&fiblet_last(words)>0u){
width=fiblet_step(words)&7u;
if(width==0u){
lo=ivec3(0);
width=FIBLET_PLAIN_BYTES;
return;
}
lo=ivec3(codes_at(byte),codes_at(byte + 4u),codes_at(byte + 8u));
n=uvec2(codes_at(byte + 12u),codes_at(byte + 16u));
byte +=FIBLET_WIDE_HEADER;
}
#endif
}
ivec3 lattice_cell(uint byte,uint width,ivec3 lo,uvec2 n){
#if FEATURE_WIDE_LATTICE
if(width==FIBLET_PLAIN_BYTES)return lo + ivec3(codes_at(byte),codes_at(byte + 4u),codes_at(byte + 8u));
#endif
uint code=codes_at(byte)&(0xFFFFFFFFu>>(32u - 8u*width));
uint row=code/n.x;
return lo + ivec3(code - row*n.x,row%n.y,row/n.y);
}
#endif
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
};
Walk walk;
vec3 walk_anchor;
vec3 walk_point;
vec3 walk_delta;
vec4 walk_frame;
#if __VERSION__ >= 400
precise walk_anchor;
precise walk_point;
precise walk_delta;
precise walk_frame;
#endif
void walk_begin(uint f){
uvec3 words=decoding_words(f);
walk_anchor=anchor_local(f);
walk_point=walk_anchor;
walk_delta=vec3(0.0);
walk.last=fiblet_last(words);
walk.kind=fiblet_kind(words);
walk.byte=first_code(f,words);
#if FEATURE_DIRECTION
walk.cap=fiblet_cap(words);
walk.scale=rotation_scale(walk.cap);
walk.step=step_length(words);
walk_frame=first_frame(fiblet_shape(words));
#endif
#if FEATURE_LATTICE
if(walk.kind!=KIND_DIRECTION){
walk.k=ivec3(0);
walk.step=lattice_edge*exp2(-float(fiblet_cap(words)));
lattice_box(words,walk.byte,walk.lo,walk.n,walk.width);
}
#endif
}
void walk_next(uint i){
#if FEATURE_LATTICE
if(walk.kind!=KIND_DIRECTION){
ivec3 cell=lattice_cell(walk.byte,walk.width,walk.lo,walk.n);
walk.byte +=walk.width;
walk.k +=cell;
walk_delta=walk.step*vec3(cell);
walk_point=walk_anchor + walk.step*vec3(walk.k);
return;
}
#endif
#if FEATURE_DIRECTION
if(i>1u){
walk_frame=turned(walk_frame,rotation(walk.cap,code_at(walk.byte + i - 2u),walk.scale));
}
walk_delta=walk.step*rotated_x(walk_frame);
walk_point +=walk_delta;
#endif
}
struct Capsule{vec3 a;vec3 b;float r;float slip;};
float radius_of(uint f){return float(bitfieldExtract(bound_word(f>>1),int(f&1u)*16,16))*radius_scale;}
vec3 end_vector(uint f){
uint word=bound_word(chunk_end_words + rank_of(f)- chunk_first_rank);
precise vec3 v=end_vector_scale*vec3(fiblet_end_vector(word));
return v;
}
Capsule capsule_of(uint f){
precise vec3 a=anchor_local(f),b;
bool end=ends(f);
if(end)b=a + end_vector(f);
else b=anchor_local(f + 1u);
return Capsule(a,b,radius_of(f),end?0.867*end_vector_scale:0.0);
}
float body_of(Capsule c){
#if FEATURE_TUBES
return c.r + tube_radius;
#else
return c.r;
#endif
}
float nearest_w(Capsule c){
vec4 row=vec4(window_from_local[0].w,window_from_local[1].w,window_from_local[2].w,window_from_local[3].w);
precise float wa=dot(row.xyz,c.a)+ row.w,wb=dot(row.xyz,c.b)+ row.w;
return min(wa,wb)- c.r*w_per_mm;
}
bool is_one_segment(Capsule c){
precise float scale=most_pixels_per_mm,w=nearest_w(c),length=distance(c.a,c.b);
return w>0.0&&(max(c.r,c.slip)*scale<=segment_deviation*w||(length + 2.0*c.r)*scale<=segment_size*w);
}
vec3 first_segment(uint f){
uvec3 words=decoding_words(f);
if(fiblet_last(words)==0u)return ends(f)?vec3(0.0):anchor_local(f + 1u)- anchor_local(f);
#if FEATURE_LATTICE
if(fiblet_kind(words)!=KIND_DIRECTION){
uint byte=first_code(f,words),width;
uvec2 n;
ivec3 lo;
lattice_box(words,byte,lo,n,width);
return lattice_edge*exp2(-float(fiblet_cap(words)))*vec3(lattice_cell(byte,width,lo,n));
}
#endif
#if FEATURE_DIRECTION
return step_length(words)*rotated_x(first_frame(fiblet_shape(words)));
#else
return vec3(0.0);
#endif
}
bool alike_after(uint f,bool whole){
#if FEATURE_POINT_MASK
return false;
#else
return!ends(f)&&f + 1u<chunk_fiblets&&is_one_segment(capsule_of(f + 1u))==whole;
#endif
}
vec3 direction_before(uint f,bool whole){
return!whole||f==0u||begins(f)?vec3(0.0):anchor_local(f)- anchor_local(f - 1u);
}
vec3 direction_after(uint f,bool whole){
if(ends(f)||f + 1u>=chunk_fiblets)return vec3(0.0);
if(!whole)return first_segment(f + 1u);
return ends(f + 1u)?end_vector(f + 1u):anchor_local(f + 2u)- anchor_local(f + 1u);
}
const uint SHARE=20u;
layout(location=0)in uvec2 item;
out vec4 o0;out vec4 o1;out vec4 o2;out vec4 o3;out vec4 o4;out vec4 o5;out vec4 o6;out vec4 o7;
out vec4 o8;out vec4 o9;out vec4 o10;out vec4 o11;out vec4 o12;out vec4 o13;out vec4 o14;
vec3 points[SHARE];
void main(){
uint f=item.x,first=item.y*SHARE,stop=first + SHARE;
walk_begin(f);
uint last=walk.last;
vec3 point=walk_point;
if(first==0u)points[0]=point;
for(uint i=1u;i<=min(last,stop - 1u);++i){
walk_next(i);
if(i>=first)points[i - first]=walk_point;
}
if(last + 1u<stop){
bool end=ends(f);
vec3 next=end||f + 1u>=chunk_fiblets?walk_point:anchor_local(f + 1u),after=next;
if(!end)after=next + direction_after(f,false);
else if(last==0u&&!begins(f)&&f>0u){
walk_begin(f - 1u);
for(uint i=1u;i<=walk.last;++i)walk_next(i);
after=next +(next - walk_point);
}
for(uint i=max(last + 1u,first);i<stop;++i)points[i - first]=i==last + 1u?next:after;
}
o0=vec4(points[0],points[1].x);o1=vec4(points[1].yz,points[2].xy);o2=vec4(points[2].z,points[3]);
o3=vec4(points[4],points[5].x);o4=vec4(points[5].yz,points[6].xy);o5=vec4(points[6].z,points[7]);
o6=vec4(points[8],points[9].x);o7=vec4(points[9].yz,points[10].xy);o8=vec4(points[10].z,points[11]);
o9=vec4(points[12],points[13].x);o10=vec4(points[13].yz,points[14].xy);o11=vec4(points[14].z,points[15]);
o12=vec4(points[16],points[17].x);o13=vec4(points[17].yz,points[18].xy);o14=vec4(points[18].z,points[19]);
gl_Position=vec4(0.0);
}
`,"page/image.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
in vec2 at;
uniform highp sampler2D pixels;
uniform float opacity;
layout(location=0)out vec4 colour;
void main(){
colour=texture(pixels,at);
if(colour.a==0.0)discard;
colour.a*=opacity;
}
`,"page/image.vert":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
uniform mat4 clip_from_data;
uniform vec3 corner;
uniform vec3 across;
uniform vec3 up;
out vec2 at;
void main(){
at=vec2(gl_VertexID&1,gl_VertexID>>1);
gl_Position=clip_from_data*vec4(corner + at.x*across + at.y*up,1.0);
}
`,"page/none.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
out vec4 colour;
void main(){colour=vec4(0.0);}
`,"page/resolve.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
const uint FIBLET_MAX_POINTS=60u;
const uint FIBLET_PAGE_BITS=14u;
const uint FIBLET_CAPS=16u;
const float FIBLET_DIRECTION_SCALE=32767.0;
const float FIBLET_STEP_LEVELS=1023.0;
const uint FIBLET_WIDE_HEADER=20u;
const uint FIBLET_PLAIN_BYTES=12u;
const uint FIBLET_ANCHORS_WORDS=2u;
const uint FIBLET_DECODING_WORDS=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_LATTICE8=1u;
const uint KIND_LATTICE16=2u;
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
uint fiblet_point(uvec3 words){return bitfieldExtract(words.z,0,20);}
uint fiblet_last(uvec3 words){return bitfieldExtract(words.z,20,6);}
uint fiblet_cap(uvec3 words){return bitfieldExtract(words.z,26,4);}
uint fiblet_kind(uvec3 words){return bitfieldExtract(words.z,30,2);}
ivec3 fiblet_end_vector(uint word){return ivec3(bitfieldExtract(int(word),0,10),bitfieldExtract(int(word),10,10),bitfieldExtract(int(word),20,10));}
uint packed_direction(vec3 d){
float norm=abs(d.x)+ abs(d.y)+ abs(d.z);
vec2 s=d.yz/norm;
if(d.x<0.0)s=(1.0 - abs(s.yx))*vec2(s.x<0.0?-1.0:1.0,s.y<0.0?-1.0:1.0);
ivec2 i=ivec2(round(clamp(s,-1.0,1.0)*FIBLET_DIRECTION_SCALE));
return uint(i.x&0xFFFF)|(uint(i.y)<<16u);
}
uint packed_tangent(vec3 delta,uint before){
float size=max(abs(delta.x),max(abs(delta.y),abs(delta.z)));
return size>0.0?packed_direction(delta/size):before;
}
vec3 unit_or_none(vec3 d){
float size=max(abs(d.x),max(abs(d.y),abs(d.z)));
return size>0.0?normalize(d/size):vec3(0.0);
}
vec3 mean_direction(vec3 before,vec3 after){
vec3 sum=before + after;
float square=dot(sum,sum);
return square>1e-6?sum*inversesqrt(square):before;
}
struct Tangents{vec3 start;vec3 end;};
Tangents tangents_of(vec3 before,vec3 here,vec3 after,bool leads){
Tangents t=Tangents(mean_direction(before,here),vec3(0.0));
if(here!=vec3(0.0))before=here;
t.end=leads&&after!=vec3(0.0)?after:mean_direction(before,after);
if(t.start==vec3(0.0))t.start=t.end;
return t;
}
vec3 tangent_between(Tangents ends,float t){
vec3 d=mix(ends.start,ends.end,t);
return dot(d,d)>1e-6?d:ends.start;
}
uvec2 packed_tangents(Tangents ends){return uvec2(packed_tangent(ends.start,0u),packed_tangent(ends.end,0u));}
vec3 unpacked_tangent(uint word){
ivec2 s=ivec2(int(word<<16)>>16,int(word)>>16);
vec2 p=vec2(s)/FIBLET_DIRECTION_SCALE;
float x=1.0 - abs(p.x)- abs(p.y);
if(x<0.0)p=(1.0 - abs(p.yx))*vec2(s.x<0?-1.0:1.0,s.y<0?-1.0:1.0);
return normalize(vec3(x,p));
}
Tangents unpacked_tangents(uvec2 words){return Tangents(unpacked_tangent(words.x),unpacked_tangent(words.y));}
const int MOST_LIGHTS=8;
uniform int light_count;
uniform vec3 light_colour[MOST_LIGHTS];
uniform vec4 light_place[MOST_LIGHTS];
uniform vec3 light_sum;
uniform float light_standing;
vec3 to_light(int i,vec3 place){return normalize(light_place[i].xyz - light_place[i].w*place);}
float across_line(vec3 tangent,vec3 d){
float along=dot(tangent,d);
along*=along;
return max(0.0,1.0 - along*along);
}
vec3 light_on_line(vec3 own,vec3 tangent,vec3 place,bool illuminated,vec4 reflects,vec3 sheen){
vec3 sight=normalize(-place),normal=sight - tangent*dot(tangent,sight);
normal=length(normal)>1e-3?normalize(normal):sight;
vec3 diffuse=vec3(0.0),shine=vec3(0.0);
for(int i=0;i<light_count;++i){
vec3 l=to_light(i,place);
float along=dot(tangent,l),sine=sqrt(max(0.0,1.0 - along*along));
diffuse +=light_colour[i]*(illuminated?sine:across_line(tangent,l));
if(reflects.z>0.0){
float spread=illuminated?sine:sqrt(max(0.0,1.0 - along*along));
vec3 back=-along*tangent + spread*normal;
shine +=light_colour[i]*pow(max(1e-5,dot(back,sight)),reflects.w);
}
}
vec3 on;
if(illuminated)on=diffuse/max(1.0,max(light_sum.r,max(light_sum.g,light_sum.b)));
else{
float brightest=max(light_sum.r,max(light_sum.g,light_sum.b));
vec3 tint=light_sum/max(brightest,1e-6);
tint=mix(vec3(1.0),tint,1.0 - min(tint.r,min(tint.g,tint.b)));
vec3 share=min(diffuse/max(light_sum,vec3(1e-6)),vec3(1.0));
share=mix(vec3(across_line(tangent,vec3(-0.57735027,0.57735027,0.57735027))),share,light_standing);
on=min(brightest,1.0)*tint*mix(vec3(0.6),vec3(1.0),share);
}
return reflects.x*own + reflects.y*on*own + reflects.z*sheen*shine;
}
vec3 light_on_surface(vec3 own,vec3 normal,vec3 place,vec4 reflects,vec3 sheen){
vec3 diffuse=vec3(0.0),shine=vec3(0.0),sight=normalize(-place);
for(int i=0;i<light_count;++i){
vec3 l=to_light(i,place);
float facing=max(0.0,dot(normal,l));
diffuse +=facing*light_colour[i];
if(reflects.z>0.0&&facing>0.0)shine +=light_colour[i]*pow(max(0.0,dot(reflect(-l,normal),sight)),reflects.w);
}
return reflects.x*own + reflects.y*diffuse*own + reflects.z*sheen*shine;
}
uniform highp sampler2D table;
uniform vec4 table_range;
uniform int logarithm;
vec4 of_value(float value){
int n=int(table_range.w),entry;
if((floatBitsToUint(value)&0x7FFFFFFFu)>0x7F800000u)entry=n + 2;
else{
if(logarithm==1)value=value>0.0?log(value)*0.4342944819032518:-3.0e38;
if(value<table_range.x)entry=n;
else if(value>table_range.y)entry=n + 1;
else entry=int(min((value - table_range.x)*table_range.z,float(n - 1)));
}
return texelFetch(table,ivec2(entry&4095,entry>>12),0);
}
uniform highp usampler2D texels;
uniform highp sampler2D depths;
uniform highp sampler2D colours;
uniform uint layer;
uniform int mode;
uniform vec3 one_colour;
uniform int light;
uniform vec4 reflects;
uniform vec3 sheen;
uniform uint marked;
uniform mat3 data_to_view;
uniform mat4 pixel_to_view;
uniform float parallel;
uniform vec2 picture;
layout(location=0)out vec4 colour;
void main(){
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
vec3 lit=own.rgb;
if(light!=0){
vec2 ndc=2.0*(vec2(pixel)+ 0.5)/picture - 1.0;
vec4 place=pixel_to_view*vec4(ndc,2.0*texelFetch(depths,pixel,0).r - 1.0,1.0);
lit=light_on_line(own.rgb,normalize(data_to_view*tangent),place.xyz/place.w,light==2,reflects,sheen);
}
if(streamline==marked)lit=mix(lit,vec3(1.0,0.9,0.2),0.75);
colour=vec4(lit,1.0);
}
`,"page/screen.vert":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
void main(){gl_Position=vec4(gl_VertexID==1?3.0:-1.0,gl_VertexID==2?3.0:-1.0,0.0,1.0);}
`,"page/segment.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define FEATURE_CLIPPING 1
#define FEATURE_CLIPPING_DEPTH 1
#define FEATURE_CLIP_PLANES 1
#define FEATURE_TUBES 0
#define FEATURE_VALUES_COLOUR 1
#define FEATURE_VALUES_STORED 1
#define FEATURE_WIDE_LINES 1
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
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
#if FEATURE_TUBES
#endif
vec4 to_homogeneous(vec3 p){
precise vec4 c=window_from_local[0]*p.x + window_from_local[1]*p.y + window_from_local[2]*p.z
+ window_from_local[3];
return c;
}
vec3 above_lower(vec4 c){
precise vec3 d=c.xyz + vec3(vec2(half_line_width),0.0)*c.w;
return d;
}
vec3 below_upper(vec4 c){
precise vec3 d=vec3(viewport + half_line_width,1.0)*c.w - c.xyz;
return d;
}
bool in_volume(vec4 c){
return all(greaterThanEqual(above_lower(c),vec3(0.0)))&&all(greaterThanEqual(below_upper(c),vec3(0.0)));
}
vec4 to_window(vec4 c){
precise float r=1.0/max(c.w,1e-30);
precise vec4 window=vec4(c.xyz*r,c.w);
return window;
}
bool clip_segment(vec4 a,vec4 b,out float t0,out float t1){
t0=0.0;
t1=1.0;
vec3 a_low=above_lower(a),a_high=below_upper(a),b_low=above_lower(b),b_high=below_upper(b);
for(int side=0;side<6;++side){
int axis=side>>1;
float da=(side&1)==0?a_low[axis]:a_high[axis],db=(side&1)==0?b_low[axis]:b_high[axis];
if(da<0.0&&db<0.0)return false;
precise float t=da/(da - db);
if(da<0.0)t0=max(t0,t);
else if(db<0.0)t1=min(t1,t);
}
return t0<=t1;
}
bool clip_window(vec2 a,vec2 b,out float t0,out float t1){
vec2 margin=vec2(half_line_width),run=b - a;
precise vec2 inverse=1.0/mix(run,vec2(1e-20),equal(run,vec2(0.0)));
precise vec2 low=(-margin - a)*inverse,high=(viewport + margin - a)*inverse;
vec2 enter=min(low,high),leave=max(low,high);
t0=clamp(max(enter.x,enter.y),0.0,1.0);
t1=clamp(min(leave.x,leave.y),0.0,1.0);
return max(enter.x,enter.y)<=min(leave.x,leave.y)&&min(leave.x,leave.y)>=0.0&&max(enter.x,enter.y)<=1.0;
}
uint depth_key(float z){return uint(int(clamp(z,0.0,0.99999988)*2147483648.0))<<1u;}
const vec2 CELL_SHIFT=vec2(23.0,23.0)/256.0;
vec2 in_picture(vec4 window){
#if FEATURE_CLIPPING
return clamp(window.xy,vec2(0.0),viewport - 0.01);
#else
return window.xy;
#endif
}
vec2 pixel_of(vec4 window){return floor(in_picture(window));}
struct Cells{
ivec2 first;
vec2 run;
int count;
float shift;
float inverse;
float square;
};
Cells cells_between(ivec2 p,ivec2 q){
ivec2 run=q - p,size=abs(run);
int n=max(size.x,size.y);
bool steep=size.y>size.x;
float shift=steep?(run.y<0?-CELL_SHIFT.y:CELL_SHIFT.y):(run.x<0?-CELL_SHIFT.x:CELL_SHIFT.x);
vec2 way=vec2(run);
return Cells(p,way,n,shift,1.0/float(max(n,1)),1.0/max(dot(way,way),1.0));
}
#if FEATURE_CLIP_PLANES
layout(std140)uniform ClipPlanes{
vec4 clip_planes[8];
vec2 clip_tilts[8];
float clip_brushes[8];
int clip_plane_count;
float clip_rounding;
};
float clip_height_of(int plane,vec3 p){
precise float h=dot(clip_planes[plane].xyz,p)+ clip_planes[plane].w;
return h;
}
float clip_height(vec3 p){
float least=clip_height_of(0,p);
for(int plane=1;plane<clip_plane_count;++plane)least=min(least,clip_height_of(plane,p));
return least;
}
bool clip_touches(vec3 centre,float radius){
float margin=radius + 2.0*clip_rounding;
float w=window_from_local[0].w*centre.x + window_from_local[1].w*centre.y + window_from_local[2].w*centre.z;
w=max(w + window_from_local[3].w + radius*w_per_mm,0.0);
for(int plane=0;plane<clip_plane_count;++plane){
if(clip_height_of(plane,centre)<margin + w*clip_brushes[plane])return true;
}
return false;
}
bool clip_by_planes(vec3 a,vec3 b,inout float t0,inout float t1){
for(int plane=0;plane<clip_plane_count;++plane){
precise float ha=clip_height_of(plane,a),hb=clip_height_of(plane,b);
if(ha<0.0&&hb<0.0)return false;
precise float t=ha/(ha - hb);
if(ha<0.0)t0=max(t0,t);
else if(hb<0.0)t1=min(t1,t);
}
return t0<=t1;
}
bool on_kept_side(vec3 p){return clip_height(p)>=0.0;}
#else
bool clip_by_planes(vec3 a,vec3 b,inout float t0,inout float t1){return true;}
bool on_kept_side(vec3 p){return true;}
#endif
#if FEATURE_TUBES
#endif
struct Vertex{
vec3 local;
vec4 clip;
vec4 window;
bool inside;
};
struct ClippedSegment{
vec4 a;
vec4 b;
float t0;
float t1;
bool start;
bool cap;
float reach;
bool thin;
};
Vertex vertex_of(vec3 p){
precise vec4 clip=to_homogeneous(p);
precise vec4 window=to_window(clip);
bool inside=true;
#if FEATURE_CLIPPING_DEPTH
inside=in_volume(clip)&&on_kept_side(p);
#endif
return Vertex(p,clip,window,inside);
}
bool clip_in_space(Vertex from,Vertex to,inout ClippedSegment piece){
if(from.inside&&to.inside)return true;
float t0,t1;
if(!clip_segment(from.clip,to.clip,t0,t1))return false;
if(!clip_by_planes(from.local,to.local,t0,t1))return false;
if(t0>0.0)piece.a=to_window(from.clip + t0*(to.clip - from.clip));
if(t1<1.0)piece.b=to_window(from.clip + t1*(to.clip - from.clip));
piece=ClippedSegment(piece.a,piece.b,t0,t1,piece.start||t0>0.0,piece.cap||t1<1.0,0.0,false);
return true;
}
bool clip_in_window(Vertex from,Vertex to,inout ClippedSegment piece){
float t0,t1;
bool any_part=clip_window(from.window.xy,to.window.xy,t0,t1);
precise vec4 run=to.window - from.window,a=from.window + t0*run,b=t1<1.0?from.window + t1*run:to.window;
piece=ClippedSegment(a,b,t0,t1,piece.start||t0>0.0,piece.cap||t1<1.0,0.0,false);
return any_part;
}
bool piece_of(Vertex from,Vertex to,bool start,bool cap,out ClippedSegment piece){
piece=ClippedSegment(from.window,to.window,0.0,1.0,start,cap,0.0,false);
#if FEATURE_TUBES
Outline outline;
bool any_part=outline_of(from.clip,to.clip,outline);
piece=ClippedSegment(outline.a,outline.b,outline.t0,outline.t1,start,cap,outline.reach,outline.thin);
return any_part;
#elif FEATURE_CLIPPING_DEPTH
return clip_in_space(from,to,piece);
#elif FEATURE_CLIPPING
return clip_in_window(from,to,piece);
#else
return true;
#endif
}
bool piece_of(vec3 from,vec3 to,bool start,bool cap,out ClippedSegment piece){
return piece_of(vertex_of(from),vertex_of(to),start,cap,piece);
}
float corrected(float s,vec2 w){
return clamp(s*w.x/max((1.0 - s)*w.y + s*w.x,1e-30),0.0,1.0);
}
float along_segment(Vertex from,Vertex to,ClippedSegment piece,float s){
#if FEATURE_TUBES
return s;
#elif FEATURE_CLIPPING_DEPTH
return mix(piece.t0,piece.t1,corrected(s,vec2(piece.a.w,piece.b.w)));
#elif FEATURE_CLIPPING
return corrected(mix(piece.t0,piece.t1,s),vec2(from.window.w,to.window.w));
#else
return corrected(s,vec2(piece.a.w,piece.b.w));
#endif
}
const float EDGE_STEPS=448.0;
const float EDGE_LEAST=2.0;
const float WIDTH_STEPS=32.0;
uint packed_edges(vec2 n,float e,float w,uint end){
vec2 q=n/max(abs(n.x)+ abs(n.y),1e-30);
int turn=int((q.y>=0.0?1.0 - q.x:3.0 + q.x)*512.0 + 0.5)&2047;
int inside=int(clamp((e + EDGE_LEAST)*EDGE_STEPS + 0.5,0.0,2047.0));
int across=int(clamp(w*WIDTH_STEPS + 0.5,1.0,127.0));
return uint(turn|(inside<<11)|(across<<22))|(end<<29u);
}
struct Edges{
vec2 n;
float e;
float w;
uint end;
float stop;
};
Edges unpacked_edges(uint word){
float turn=float(int(word&2047u))/512.0,x=abs(turn - 2.0)- 1.0;
int width=int((word>>22u)&127u),end=int(word>>29u);
return Edges(normalize(vec2(x,turn<2.0?1.0 - abs(x):abs(x)- 1.0)),
float(int((word>>11u)&2047u))/EDGE_STEPS - EDGE_LEAST,width==127?128.0:float(width)/WIDTH_STEPS,
uint(end),float(end>3?end - 5:end - 2)/3.0);
}
#if FEATURE_TUBES || FEATURE_WIDE_LINES
uint capsule_edges(vec2 centre,vec2 run,float r){
vec2 away=centre - clamp(dot(centre,run)/max(dot(run,run),1e-12),0.0,1.0)*run;
float size=length(away);
vec2 n=size>1e-4?away/size:vec2(-run.y,run.x)/max(length(run),1e-6);
return packed_edges(n,r - size,2.0*r,0u);
}
#endif
#if FEATURE_TUBES
uint thin_tube_edges(Tube t,vec2 centre,vec2 run,float r){
float square=dot(run,run),foot=dot(centre,run)/max(square,1e-12);
foot=square>1e-6?clamp(foot,t.start?0.0:-1e6,t.cap?1.0:1e6):clamp(foot,0.0,1.0);
vec2 away=centre - foot*run;
float size=length(away);
vec2 n=size>1e-4?away/size:vec2(-run.y,run.x)/max(length(run),1e-6);
return packed_edges(n,r - size,2.0*r,0u);
}
uint tube_edges(Tube t,vec4 c0,vec4 c1,vec2 pixel,Hit hit){
vec3 d=normalize(tube_ray + tube_perspective*(pixel.x*tube_ray_x + pixel.y*tube_ray_y)),face=d;
if(hit.t>0.0&&hit.t<1.0){
vec3 across=d - dot(d,t.axis)*t.axis;
if(dot(across,across)>1e-4)face=normalize(across);
}
vec3 beside=hit.normal - dot(hit.normal,face)*face;
float share=length(beside);
vec3 out_of=share>1e-4?beside/share:normalize(tube_ray_x);
vec3 at=hit.t*t.size*t.axis + tube_radius*hit.normal;
vec2 way=vec2(dot(window_gradient(0),out_of),dot(window_gradient(1),out_of))- pixel*dot(window_gradient(3),out_of);
float pixels=length(way),r=tube_radius*pixels/max(c0.w + dot(window_gradient(3),at),1e-30);
Outline outline;
if(r<half_line_width&&outline_of(c0,c1,outline))return thin_tube_edges(t,pixel - outline.a.xy,outline.b.xy - outline.a.xy,r);
return packed_edges(pixels>0.0?way/pixels:vec2(1.0,0.0),(1.0 - share)*r,2.0*r,0u);
}
#endif
#if !(FEATURE_TUBES || FEATURE_WIDE_LINES)
vec4 parts_of(ClippedSegment piece){
vec4 at=vec4(in_picture(piece.a),in_picture(piece.b));
return floor((at - floor(at))*256.0)/256.0;
}
uint packed_parts(ClippedSegment piece){
uvec4 parts=uvec4(parts_of(piece)*256.0);
return parts.x|(parts.y<<8u)|(parts.z<<16u)|(parts.w<<24u);
}
uint thin_edges(ivec2 first,ivec2 last,vec2 at,vec4 parts,bool start,bool cap){
vec2 run=vec2(last - first),a=parts.xy - 0.5 - at,d=run + parts.zw - parts.xy;
float square=dot(d,d),shrink=inversesqrt(max(square,1e-6));
vec2 along=square>1e-6?d:vec2(1.0,0.0);
float left=(along.y*a.x - along.x*a.y)*shrink;
bool turned=left<0.0,begins=start&&at==vec2(0.0),ends=cap&&at==run;
float stop=dot(along,begins?a:a + d)*shrink;
uint third=uint(int(2.5 + clamp(turned?3.0*stop:-3.0*stop,-1.0,1.0)));
uint end=begins&&ends?7u:begins||ends?(turned==ends?third:third + 3u):0u;
return packed_edges(turned?vec2(along.y,-along.x):vec2(-along.y,along.x),0.5 - abs(left),1.0,end);
}
vec4 unpacked_parts(uint word){return vec4((uvec4(word)>>uvec4(0u,8u,16u,24u))&255u)/256.0;}
#endif
const float JOINT_LEAST=0.1,JOINT_OVERLAP=0.05;
const uint NO_ONWARD=0x80008000u;
vec2 onward_at(vec4 end,vec3 ahead){
vec4 c=window_from_local[0]*ahead.x + window_from_local[1]*ahead.y + window_from_local[2]*ahead.z;
vec2 run=c.xy - end.xy*c.w;
float size=length(run);
return size>JOINT_LEAST*end.w?run/size:vec2(0.0);
}
bool beyond_joint(vec2 onward,vec2 away){return dot(onward,away)>JOINT_OVERLAP;}
uint packed_onward(vec2 onward){
if(onward==vec2(0.0))return NO_ONWARD;
ivec2 s=ivec2(round(32767.0*onward));
return uint(s.x&0xFFFF)|(uint(s.y)<<16u);
}
vec2 unpacked_onward(uint word){
return word==NO_ONWARD?vec2(0.0):vec2(ivec2(int(word<<16)>>16,int(word)>>16))/32767.0;
}
const uint FIBLET_MAX_POINTS=60u;
const uint FIBLET_PAGE_BITS=14u;
const uint FIBLET_CAPS=16u;
const float FIBLET_DIRECTION_SCALE=32767.0;
const float FIBLET_STEP_LEVELS=1023.0;
const uint FIBLET_WIDE_HEADER=20u;
const uint FIBLET_PLAIN_BYTES=12u;
const uint FIBLET_ANCHORS_WORDS=2u;
const uint FIBLET_DECODING_WORDS=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_LATTICE8=1u;
const uint KIND_LATTICE16=2u;
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
uint fiblet_point(uvec3 words){return bitfieldExtract(words.z,0,20);}
uint fiblet_last(uvec3 words){return bitfieldExtract(words.z,20,6);}
uint fiblet_cap(uvec3 words){return bitfieldExtract(words.z,26,4);}
uint fiblet_kind(uvec3 words){return bitfieldExtract(words.z,30,2);}
ivec3 fiblet_end_vector(uint word){return ivec3(bitfieldExtract(int(word),0,10),bitfieldExtract(int(word),10,10),bitfieldExtract(int(word),20,10));}
uint packed_direction(vec3 d){
float norm=abs(d.x)+ abs(d.y)+ abs(d.z);
vec2 s=d.yz/norm;
if(d.x<0.0)s=(1.0 - abs(s.yx))*vec2(s.x<0.0?-1.0:1.0,s.y<0.0?-1.0:1.0);
ivec2 i=ivec2(round(clamp(s,-1.0,1.0)*FIBLET_DIRECTION_SCALE));
return uint(i.x&0xFFFF)|(uint(i.y)<<16u);
}
uint packed_tangent(vec3 delta,uint before){
float size=max(abs(delta.x),max(abs(delta.y),abs(delta.z)));
return size>0.0?packed_direction(delta/size):before;
}
vec3 unit_or_none(vec3 d){
float size=max(abs(d.x),max(abs(d.y),abs(d.z)));
return size>0.0?normalize(d/size):vec3(0.0);
}
vec3 mean_direction(vec3 before,vec3 after){
vec3 sum=before + after;
float square=dot(sum,sum);
return square>1e-6?sum*inversesqrt(square):before;
}
struct Tangents{vec3 start;vec3 end;};
Tangents tangents_of(vec3 before,vec3 here,vec3 after,bool leads){
Tangents t=Tangents(mean_direction(before,here),vec3(0.0));
if(here!=vec3(0.0))before=here;
t.end=leads&&after!=vec3(0.0)?after:mean_direction(before,after);
if(t.start==vec3(0.0))t.start=t.end;
return t;
}
vec3 tangent_between(Tangents ends,float t){
vec3 d=mix(ends.start,ends.end,t);
return dot(d,d)>1e-6?d:ends.start;
}
uvec2 packed_tangents(Tangents ends){return uvec2(packed_tangent(ends.start,0u),packed_tangent(ends.end,0u));}
vec3 unpacked_tangent(uint word){
ivec2 s=ivec2(int(word<<16)>>16,int(word)>>16);
vec2 p=vec2(s)/FIBLET_DIRECTION_SCALE;
float x=1.0 - abs(p.x)- abs(p.y);
if(x<0.0)p=(1.0 - abs(p.yx))*vec2(s.x<0?-1.0:1.0,s.y<0?-1.0:1.0);
return normalize(vec3(x,p));
}
Tangents unpacked_tangents(uvec2 words){return Tangents(unpacked_tangent(words.x),unpacked_tangent(words.y));}
#define VARYING flat in
#ifndef VARYING
#define VARYING flat out
#endif
VARYING uvec4 seg_ids;
VARYING vec4 seg_start;
VARYING vec4 seg_end;
VARYING vec4 seg_along;
#if FEATURE_VALUES_COLOUR
VARYING uvec2 seg_colours;
#endif
#if FEATURE_WIDE_LINES
VARYING vec2 seg_onward;
#if FEATURE_CLIP_PLANES
VARYING vec3 seg_from;
VARYING vec3 seg_to;
#endif
#endif
layout(location=0)out uvec4 out_texel;
#if FEATURE_VALUES_STORED
uniform vec2 shown_values;
bool none(float value){return(floatBitsToUint(value)&0x7FFFFFFFu)>0x7F800000u;}
float value_between(float t){
vec2 ends=seg_along.zw;
if(none(ends.x)||none(ends.y))return t<0.5?ends.x:ends.y;
return mix(ends.x,ends.y,t);
}
#endif
void write(float s,uint edges){
float ratio=seg_start.w/max(seg_end.w,1e-30);
float t=mix(seg_along.x,seg_along.y,clamp(s*ratio/max(1.0 - s + s*ratio,1e-30),0.0,1.0));
Tangents ends=unpacked_tangents(seg_ids.yz);
uint bits=0u;
#if FEATURE_VALUES_STORED
float value=value_between(t);
if(shown_values.x<=shown_values.y&&!(value>=shown_values.x&&value<=shown_values.y))discard;
bits=floatBitsToUint(value);
#endif
#if FEATURE_VALUES_COLOUR
bits=packUnorm4x8(mix(unpackUnorm4x8(seg_colours.x),unpackUnorm4x8(seg_colours.y),t));
#endif
out_texel=uvec4(seg_ids.x,packed_tangent(tangent_between(ends,t),0u),edges,bits);
}
#if FEATURE_WIDE_LINES
#if FEATURE_CLIP_PLANES
bool brush_kept(float s,vec2 away){
for(int plane=0;plane<clip_plane_count;++plane){
vec2 heights=vec2(clip_height_of(plane,seg_from),clip_height_of(plane,seg_to));
vec2 h=max(heights/max(vec2(seg_start.w,seg_end.w),vec2(1e-30)),vec2(0.0));
if(h.x + s*(h.y - h.x)+ dot(clip_tilts[plane],away)<0.0)return false;
}
return true;
}
#endif
void main(){
vec2 run=seg_end.xy - seg_start.xy,centre=gl_FragCoord.xy - seg_start.xy;
float foot=dot(centre,run)/max(dot(run,run),1e-12),s=clamp(foot,0.0,1.0);
vec2 away=centre - s*run;
if(foot<0.0&&(seg_ids.w&1u)==0u||dot(away,away)>half_line_width*half_line_width)discard;
if(foot>1.0&&beyond_joint(seg_onward,centre - run))discard;
#if FEATURE_CLIP_PLANES
if(!brush_kept(s,away))discard;
#endif
gl_FragDepth=clamp(seg_start.z +(seg_end.z - seg_start.z)*s,0.0,0.99999988);
write(s,capsule_edges(centre,run,half_line_width));
}
#else
void main(){
vec2 first=pixel_of(seg_start),run=pixel_of(seg_end)- first,at=floor(gl_FragCoord.xy)- first;
Cells cells=cells_between(ivec2(first),ivec2(first + run));
bool start=(seg_ids.w&1u)!=0u,cap=(seg_ids.w&2u)!=0u,steep=abs(run.y)>abs(run.x);
float s=1.0;
if(at==run){
if(!cap)discard;
}else{
float major=steep?at.y:at.x,way=steep?run.y:run.x,steps=abs(major);
if(major*way<0.0||steps>=float(cells.count))discard;
vec2 line=floor(0.5 + CELL_SHIFT +(steps - cells.shift)*cells.inverse*run);
if(steep?line.x!=at.x:line.y!=at.y)discard;
s=dot(at - CELL_SHIFT,run)*cells.square;
}
vec4 ends=vec4(in_picture(seg_start),in_picture(seg_end)),parts=floor((ends - floor(ends))*256.0)/256.0;
write(s,thin_edges(ivec2(first),ivec2(first + run),at,parts,start,cap));
}
#endif
`,"page/segment.vert":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define FEATURE_CLIPPING 1
#define FEATURE_CLIPPING_DEPTH 1
#define FEATURE_CLIP_PLANES 1
#define FEATURE_STREAMLINE_MASK 1
#define FEATURE_TUBES 0
#define FEATURE_VALUES_COLOUR 1
#define FEATURE_VALUES_STORED 1
#define FEATURE_WIDE_LINES 1
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
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
#if FEATURE_TUBES
#endif
vec4 to_homogeneous(vec3 p){
precise vec4 c=window_from_local[0]*p.x + window_from_local[1]*p.y + window_from_local[2]*p.z
+ window_from_local[3];
return c;
}
vec3 above_lower(vec4 c){
precise vec3 d=c.xyz + vec3(vec2(half_line_width),0.0)*c.w;
return d;
}
vec3 below_upper(vec4 c){
precise vec3 d=vec3(viewport + half_line_width,1.0)*c.w - c.xyz;
return d;
}
bool in_volume(vec4 c){
return all(greaterThanEqual(above_lower(c),vec3(0.0)))&&all(greaterThanEqual(below_upper(c),vec3(0.0)));
}
vec4 to_window(vec4 c){
precise float r=1.0/max(c.w,1e-30);
precise vec4 window=vec4(c.xyz*r,c.w);
return window;
}
bool clip_segment(vec4 a,vec4 b,out float t0,out float t1){
t0=0.0;
t1=1.0;
vec3 a_low=above_lower(a),a_high=below_upper(a),b_low=above_lower(b),b_high=below_upper(b);
for(int side=0;side<6;++side){
int axis=side>>1;
float da=(side&1)==0?a_low[axis]:a_high[axis],db=(side&1)==0?b_low[axis]:b_high[axis];
if(da<0.0&&db<0.0)return false;
precise float t=da/(da - db);
if(da<0.0)t0=max(t0,t);
else if(db<0.0)t1=min(t1,t);
}
return t0<=t1;
}
bool clip_window(vec2 a,vec2 b,out float t0,out float t1){
vec2 margin=vec2(half_line_width),run=b - a;
precise vec2 inverse=1.0/mix(run,vec2(1e-20),equal(run,vec2(0.0)));
precise vec2 low=(-margin - a)*inverse,high=(viewport + margin - a)*inverse;
vec2 enter=min(low,high),leave=max(low,high);
t0=clamp(max(enter.x,enter.y),0.0,1.0);
t1=clamp(min(leave.x,leave.y),0.0,1.0);
return max(enter.x,enter.y)<=min(leave.x,leave.y)&&min(leave.x,leave.y)>=0.0&&max(enter.x,enter.y)<=1.0;
}
uint depth_key(float z){return uint(int(clamp(z,0.0,0.99999988)*2147483648.0))<<1u;}
const vec2 CELL_SHIFT=vec2(23.0,23.0)/256.0;
vec2 in_picture(vec4 window){
#if FEATURE_CLIPPING
return clamp(window.xy,vec2(0.0),viewport - 0.01);
#else
return window.xy;
#endif
}
vec2 pixel_of(vec4 window){return floor(in_picture(window));}
struct Cells{
ivec2 first;
vec2 run;
int count;
float shift;
float inverse;
float square;
};
Cells cells_between(ivec2 p,ivec2 q){
ivec2 run=q - p,size=abs(run);
int n=max(size.x,size.y);
bool steep=size.y>size.x;
float shift=steep?(run.y<0?-CELL_SHIFT.y:CELL_SHIFT.y):(run.x<0?-CELL_SHIFT.x:CELL_SHIFT.x);
vec2 way=vec2(run);
return Cells(p,way,n,shift,1.0/float(max(n,1)),1.0/max(dot(way,way),1.0));
}
#if FEATURE_CLIP_PLANES
layout(std140)uniform ClipPlanes{
vec4 clip_planes[8];
vec2 clip_tilts[8];
float clip_brushes[8];
int clip_plane_count;
float clip_rounding;
};
float clip_height_of(int plane,vec3 p){
precise float h=dot(clip_planes[plane].xyz,p)+ clip_planes[plane].w;
return h;
}
float clip_height(vec3 p){
float least=clip_height_of(0,p);
for(int plane=1;plane<clip_plane_count;++plane)least=min(least,clip_height_of(plane,p));
return least;
}
bool clip_touches(vec3 centre,float radius){
float margin=radius + 2.0*clip_rounding;
float w=window_from_local[0].w*centre.x + window_from_local[1].w*centre.y + window_from_local[2].w*centre.z;
w=max(w + window_from_local[3].w + radius*w_per_mm,0.0);
for(int plane=0;plane<clip_plane_count;++plane){
if(clip_height_of(plane,centre)<margin + w*clip_brushes[plane])return true;
}
return false;
}
bool clip_by_planes(vec3 a,vec3 b,inout float t0,inout float t1){
for(int plane=0;plane<clip_plane_count;++plane){
precise float ha=clip_height_of(plane,a),hb=clip_height_of(plane,b);
if(ha<0.0&&hb<0.0)return false;
precise float t=ha/(ha - hb);
if(ha<0.0)t0=max(t0,t);
else if(hb<0.0)t1=min(t1,t);
}
return t0<=t1;
}
bool on_kept_side(vec3 p){return clip_height(p)>=0.0;}
#else
bool clip_by_planes(vec3 a,vec3 b,inout float t0,inout float t1){return true;}
bool on_kept_side(vec3 p){return true;}
#endif
#if FEATURE_TUBES
#endif
struct Vertex{
vec3 local;
vec4 clip;
vec4 window;
bool inside;
};
struct ClippedSegment{
vec4 a;
vec4 b;
float t0;
float t1;
bool start;
bool cap;
float reach;
bool thin;
};
Vertex vertex_of(vec3 p){
precise vec4 clip=to_homogeneous(p);
precise vec4 window=to_window(clip);
bool inside=true;
#if FEATURE_CLIPPING_DEPTH
inside=in_volume(clip)&&on_kept_side(p);
#endif
return Vertex(p,clip,window,inside);
}
bool clip_in_space(Vertex from,Vertex to,inout ClippedSegment piece){
if(from.inside&&to.inside)return true;
float t0,t1;
if(!clip_segment(from.clip,to.clip,t0,t1))return false;
if(!clip_by_planes(from.local,to.local,t0,t1))return false;
if(t0>0.0)piece.a=to_window(from.clip + t0*(to.clip - from.clip));
if(t1<1.0)piece.b=to_window(from.clip + t1*(to.clip - from.clip));
piece=ClippedSegment(piece.a,piece.b,t0,t1,piece.start||t0>0.0,piece.cap||t1<1.0,0.0,false);
return true;
}
bool clip_in_window(Vertex from,Vertex to,inout ClippedSegment piece){
float t0,t1;
bool any_part=clip_window(from.window.xy,to.window.xy,t0,t1);
precise vec4 run=to.window - from.window,a=from.window + t0*run,b=t1<1.0?from.window + t1*run:to.window;
piece=ClippedSegment(a,b,t0,t1,piece.start||t0>0.0,piece.cap||t1<1.0,0.0,false);
return any_part;
}
bool piece_of(Vertex from,Vertex to,bool start,bool cap,out ClippedSegment piece){
piece=ClippedSegment(from.window,to.window,0.0,1.0,start,cap,0.0,false);
#if FEATURE_TUBES
Outline outline;
bool any_part=outline_of(from.clip,to.clip,outline);
piece=ClippedSegment(outline.a,outline.b,outline.t0,outline.t1,start,cap,outline.reach,outline.thin);
return any_part;
#elif FEATURE_CLIPPING_DEPTH
return clip_in_space(from,to,piece);
#elif FEATURE_CLIPPING
return clip_in_window(from,to,piece);
#else
return true;
#endif
}
bool piece_of(vec3 from,vec3 to,bool start,bool cap,out ClippedSegment piece){
return piece_of(vertex_of(from),vertex_of(to),start,cap,piece);
}
float corrected(float s,vec2 w){
return clamp(s*w.x/max((1.0 - s)*w.y + s*w.x,1e-30),0.0,1.0);
}
float along_segment(Vertex from,Vertex to,ClippedSegment piece,float s){
#if FEATURE_TUBES
return s;
#elif FEATURE_CLIPPING_DEPTH
return mix(piece.t0,piece.t1,corrected(s,vec2(piece.a.w,piece.b.w)));
#elif FEATURE_CLIPPING
return corrected(mix(piece.t0,piece.t1,s),vec2(from.window.w,to.window.w));
#else
return corrected(s,vec2(piece.a.w,piece.b.w));
#endif
}
const float JOINT_LEAST=0.1,JOINT_OVERLAP=0.05;
const uint NO_ONWARD=0x80008000u;
vec2 onward_at(vec4 end,vec3 ahead){
vec4 c=window_from_local[0]*ahead.x + window_from_local[1]*ahead.y + window_from_local[2]*ahead.z;
vec2 run=c.xy - end.xy*c.w;
float size=length(run);
return size>JOINT_LEAST*end.w?run/size:vec2(0.0);
}
bool beyond_joint(vec2 onward,vec2 away){return dot(onward,away)>JOINT_OVERLAP;}
uint packed_onward(vec2 onward){
if(onward==vec2(0.0))return NO_ONWARD;
ivec2 s=ivec2(round(32767.0*onward));
return uint(s.x&0xFFFF)|(uint(s.y)<<16u);
}
vec2 unpacked_onward(uint word){
return word==NO_ONWARD?vec2(0.0):vec2(ivec2(int(word<<16)>>16,int(word)>>16))/32767.0;
}
const uint FIBLET_MAX_POINTS=60u;
const uint FIBLET_PAGE_BITS=14u;
const uint FIBLET_CAPS=16u;
const float FIBLET_DIRECTION_SCALE=32767.0;
const float FIBLET_STEP_LEVELS=1023.0;
const uint FIBLET_WIDE_HEADER=20u;
const uint FIBLET_PLAIN_BYTES=12u;
const uint FIBLET_ANCHORS_WORDS=2u;
const uint FIBLET_DECODING_WORDS=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_LATTICE8=1u;
const uint KIND_LATTICE16=2u;
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
uint fiblet_point(uvec3 words){return bitfieldExtract(words.z,0,20);}
uint fiblet_last(uvec3 words){return bitfieldExtract(words.z,20,6);}
uint fiblet_cap(uvec3 words){return bitfieldExtract(words.z,26,4);}
uint fiblet_kind(uvec3 words){return bitfieldExtract(words.z,30,2);}
ivec3 fiblet_end_vector(uint word){return ivec3(bitfieldExtract(int(word),0,10),bitfieldExtract(int(word),10,10),bitfieldExtract(int(word),20,10));}
uint packed_direction(vec3 d){
float norm=abs(d.x)+ abs(d.y)+ abs(d.z);
vec2 s=d.yz/norm;
if(d.x<0.0)s=(1.0 - abs(s.yx))*vec2(s.x<0.0?-1.0:1.0,s.y<0.0?-1.0:1.0);
ivec2 i=ivec2(round(clamp(s,-1.0,1.0)*FIBLET_DIRECTION_SCALE));
return uint(i.x&0xFFFF)|(uint(i.y)<<16u);
}
uint packed_tangent(vec3 delta,uint before){
float size=max(abs(delta.x),max(abs(delta.y),abs(delta.z)));
return size>0.0?packed_direction(delta/size):before;
}
vec3 unit_or_none(vec3 d){
float size=max(abs(d.x),max(abs(d.y),abs(d.z)));
return size>0.0?normalize(d/size):vec3(0.0);
}
vec3 mean_direction(vec3 before,vec3 after){
vec3 sum=before + after;
float square=dot(sum,sum);
return square>1e-6?sum*inversesqrt(square):before;
}
struct Tangents{vec3 start;vec3 end;};
Tangents tangents_of(vec3 before,vec3 here,vec3 after,bool leads){
Tangents t=Tangents(mean_direction(before,here),vec3(0.0));
if(here!=vec3(0.0))before=here;
t.end=leads&&after!=vec3(0.0)?after:mean_direction(before,after);
if(t.start==vec3(0.0))t.start=t.end;
return t;
}
vec3 tangent_between(Tangents ends,float t){
vec3 d=mix(ends.start,ends.end,t);
return dot(d,d)>1e-6?d:ends.start;
}
uvec2 packed_tangents(Tangents ends){return uvec2(packed_tangent(ends.start,0u),packed_tangent(ends.end,0u));}
vec3 unpacked_tangent(uint word){
ivec2 s=ivec2(int(word<<16)>>16,int(word)>>16);
vec2 p=vec2(s)/FIBLET_DIRECTION_SCALE;
float x=1.0 - abs(p.x)- abs(p.y);
if(x<0.0)p=(1.0 - abs(p.yx))*vec2(s.x<0?-1.0:1.0,s.y<0?-1.0:1.0);
return normalize(vec3(x,p));
}
Tangents unpacked_tangents(uvec2 words){return Tangents(unpacked_tangent(words.x),unpacked_tangent(words.y));}
#ifndef VARYING
#define VARYING flat out
#endif
VARYING uvec4 seg_ids;
VARYING vec4 seg_start;
VARYING vec4 seg_end;
VARYING vec4 seg_along;
#if FEATURE_VALUES_COLOUR
VARYING uvec2 seg_colours;
#endif
#if FEATURE_WIDE_LINES
VARYING vec2 seg_onward;
#if FEATURE_CLIP_PLANES
VARYING vec3 seg_from;
VARYING vec3 seg_to;
#endif
#endif
const int SHARE=20,ROW_BITS=12;
layout(location=0)in vec3 before;
layout(location=1)in vec3 from;
layout(location=2)in vec3 to;
layout(location=3)in vec3 after;
uniform highp usampler2D items;
uniform int first_item;
uniform uint layer;
#if FEATURE_STREAMLINE_MASK
uniform highp usampler2D kept;
#endif
#if FEATURE_VALUES_COLOUR
uniform highp sampler2D point_colours;
vec4 colour_of(uint point){return texelFetch(point_colours,ivec2(int(point&4095u),int(point>>12u)),0);}
#endif
#if FEATURE_VALUES_STORED
uniform highp usampler2D value_texels;
uniform vec3 value_code;
float value_of(uint point){
uint code=texelFetch(value_texels,ivec2(int(point&4095u),int(point>>12u)),0).x;
return float(code)==value_code.z?uintBitsToFloat(0x7FC00000u):value_code.x + value_code.y*float(code);
}
#endif
void main(){
int place=first_item + gl_InstanceID/SHARE;
uvec4 item=texelFetch(items,ivec2(place&((1<<ROW_BITS)- 1),place>>ROW_BITS),0);
uint points=item.z&63u,share=item.z>>8u;
bool begins=(item.z&64u)!=0u,ends=(item.z&128u)!=0u;
uint k=share*uint(SHARE)+ uint(gl_InstanceID%SHARE),count=points -(ends&&points>1u?1u:0u);
gl_Position=vec4(2.0,2.0,2.0,1.0);
if(k>=count)return;
#if FEATURE_STREAMLINE_MASK
if(texelFetch(kept,ivec2(int(item.x&4095u),int(item.x>>12u)),0).x==0u)return;
#endif
bool start=k==0u&&begins,cap=k + 1u==count&&ends;
vec2 values=vec2(0.0);
#if FEATURE_VALUES_STORED
values=vec2(value_of(item.y + k),value_of(item.y + min(k + 1u,points -(ends?1u:0u))));
#endif
ClippedSegment piece;
if(!piece_of(from,to,start,cap,piece))return;
vec3 ahead=after - to,u_here=unit_or_none(to - from),u_before=k==0u?vec3(0.0):unit_or_none(from - before);
bool leads=k + 1u==count&&!ends;
vec3 u_after=cap?vec3(0.0):unit_or_none(ahead);
Tangents tangents;
if(points==1u&&ends)tangents=Tangents(unit_or_none(ahead),unit_or_none(ahead));
else tangents=tangents_of(u_before,u_here,u_after,leads);
uvec2 packed_ends=packed_tangents(tangents);
seg_ids=uvec4(item.x|layer,packed_ends,(piece.start?1u:0u)|(piece.cap?2u:0u));
seg_start=piece.a;
seg_end=piece.b;
seg_along=vec4(piece.t0,piece.t1,values);
#if FEATURE_VALUES_COLOUR
seg_colours=uvec2(packUnorm4x8(colour_of(item.y + k)),packUnorm4x8(colour_of(item.y + min(k + 1u,points -(ends?1u:0u)))));
#endif
#if FEATURE_WIDE_LINES
seg_onward=piece.cap?vec2(0.0):onward_at(piece.b,ahead);
#if FEATURE_CLIP_PLANES
seg_from=mix(from,to,piece.t0);
seg_to=mix(from,to,piece.t1);
#endif
vec2 a=piece.a.xy,run=piece.b.xy - a;
float size=length(run),reach=half_line_width + 0.05,back=piece.start?reach:0.05;
vec2 along=size>0.0?run/size:vec2(1.0,0.0),across=vec2(-along.y,along.x);
vec2 at=((gl_VertexID&2)==0?a - back*along:piece.b.xy + reach*along)+((gl_VertexID&1)==0?-reach:reach)*across;
gl_Position=vec4(2.0*at/viewport - 1.0,0.0,1.0);
#else
vec2 p=pixel_of(piece.a)+ 0.5 + CELL_SHIFT,q=pixel_of(piece.b)+ 0.5 + CELL_SHIFT,run=q - p;
float square=dot(run,run),size=sqrt(square);
vec2 along=size>0.0?run/size:vec2(1.0,0.0),across=vec2(-along.y,along.x);
if(size==0.0&&!piece.cap)return;
const float reach=0.75;
vec2 at=((gl_VertexID&2)==0?p - reach*along:q + reach*along)+((gl_VertexID&1)==0?-reach:reach)*across;
float depth=square>0.0?piece.a.z + dot(at - p,run)/square*(piece.b.z - piece.a.z):piece.b.z;
gl_Position=vec4(2.0*at/viewport - 1.0,2.0*clamp(depth,0.0,0.99999988)- 1.0,1.0);
#endif
}
`,"page/surface.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
const int MOST_LIGHTS=8;
uniform int light_count;
uniform vec3 light_colour[MOST_LIGHTS];
uniform vec4 light_place[MOST_LIGHTS];
uniform vec3 light_sum;
uniform float light_standing;
vec3 to_light(int i,vec3 place){return normalize(light_place[i].xyz - light_place[i].w*place);}
float across_line(vec3 tangent,vec3 d){
float along=dot(tangent,d);
along*=along;
return max(0.0,1.0 - along*along);
}
vec3 light_on_line(vec3 own,vec3 tangent,vec3 place,bool illuminated,vec4 reflects,vec3 sheen){
vec3 sight=normalize(-place),normal=sight - tangent*dot(tangent,sight);
normal=length(normal)>1e-3?normalize(normal):sight;
vec3 diffuse=vec3(0.0),shine=vec3(0.0);
for(int i=0;i<light_count;++i){
vec3 l=to_light(i,place);
float along=dot(tangent,l),sine=sqrt(max(0.0,1.0 - along*along));
diffuse +=light_colour[i]*(illuminated?sine:across_line(tangent,l));
if(reflects.z>0.0){
float spread=illuminated?sine:sqrt(max(0.0,1.0 - along*along));
vec3 back=-along*tangent + spread*normal;
shine +=light_colour[i]*pow(max(1e-5,dot(back,sight)),reflects.w);
}
}
vec3 on;
if(illuminated)on=diffuse/max(1.0,max(light_sum.r,max(light_sum.g,light_sum.b)));
else{
float brightest=max(light_sum.r,max(light_sum.g,light_sum.b));
vec3 tint=light_sum/max(brightest,1e-6);
tint=mix(vec3(1.0),tint,1.0 - min(tint.r,min(tint.g,tint.b)));
vec3 share=min(diffuse/max(light_sum,vec3(1e-6)),vec3(1.0));
share=mix(vec3(across_line(tangent,vec3(-0.57735027,0.57735027,0.57735027))),share,light_standing);
on=min(brightest,1.0)*tint*mix(vec3(0.6),vec3(1.0),share);
}
return reflects.x*own + reflects.y*on*own + reflects.z*sheen*shine;
}
vec3 light_on_surface(vec3 own,vec3 normal,vec3 place,vec4 reflects,vec3 sheen){
vec3 diffuse=vec3(0.0),shine=vec3(0.0),sight=normalize(-place);
for(int i=0;i<light_count;++i){
vec3 l=to_light(i,place);
float facing=max(0.0,dot(normal,l));
diffuse +=facing*light_colour[i];
if(reflects.z>0.0&&facing>0.0)shine +=light_colour[i]*pow(max(0.0,dot(reflect(-l,normal),sight)),reflects.w);
}
return reflects.x*own + reflects.y*diffuse*own + reflects.z*sheen*shine;
}
uniform highp sampler2D table;
uniform vec4 table_range;
uniform int logarithm;
vec4 of_value(float value){
int n=int(table_range.w),entry;
if((floatBitsToUint(value)&0x7FFFFFFFu)>0x7F800000u)entry=n + 2;
else{
if(logarithm==1)value=value>0.0?log(value)*0.4342944819032518:-3.0e38;
if(value<table_range.x)entry=n;
else if(value>table_range.y)entry=n + 1;
else entry=int(min((value - table_range.x)*table_range.z,float(n - 1)));
}
return texelFetch(table,ivec2(entry&4095,entry>>12),0);
}
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
uniform vec4 reflects;
uniform vec3 sheen;
uniform int plane_count;
uniform vec4 planes[6];
layout(location=0)out vec4 colour;
void main(){
for(int i=0;i<plane_count;++i)if(dot(planes[i].xyz,data_place)+ planes[i].w<0.0)discard;
vec3 normal=smooth_normals==1?normalize(view_normal):normalize(cross(dFdx(view_place),dFdy(view_place)));
vec3 sight=parallel==1.0?vec3(0.0,0.0,1.0):normalize(-view_place);
if(dot(normal,sight)<0.0)normal=-normal;
vec4 own=by_value==1?of_value(own_value):own_colour;
vec3 lit=lighting==1?light_on_surface(own.rgb,normal,view_place,reflects,sheen):own.rgb;
colour=vec4(lit,own.a*opacity);
}
`,"page/surface.vert":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
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
void main(){
gl_Position=clip_from_data*vec4(place,1.0);
view_place=(view_from_data*vec4(place,1.0)).xyz;
view_normal=normal_to_view*normal;
own_colour=own;
data_place=place;
own_value=value;
}
`,"page/visible_edges.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
const uint FIBLET_MAX_POINTS=60u;
const uint FIBLET_PAGE_BITS=14u;
const uint FIBLET_CAPS=16u;
const float FIBLET_DIRECTION_SCALE=32767.0;
const float FIBLET_STEP_LEVELS=1023.0;
const uint FIBLET_WIDE_HEADER=20u;
const uint FIBLET_PLAIN_BYTES=12u;
const uint FIBLET_ANCHORS_WORDS=2u;
const uint FIBLET_DECODING_WORDS=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_LATTICE8=1u;
const uint KIND_LATTICE16=2u;
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
uint fiblet_point(uvec3 words){return bitfieldExtract(words.z,0,20);}
uint fiblet_last(uvec3 words){return bitfieldExtract(words.z,20,6);}
uint fiblet_cap(uvec3 words){return bitfieldExtract(words.z,26,4);}
uint fiblet_kind(uvec3 words){return bitfieldExtract(words.z,30,2);}
ivec3 fiblet_end_vector(uint word){return ivec3(bitfieldExtract(int(word),0,10),bitfieldExtract(int(word),10,10),bitfieldExtract(int(word),20,10));}
const float EDGE_STEPS=448.0;
const float EDGE_LEAST=2.0;
const float WIDTH_STEPS=32.0;
uint packed_edges(vec2 n,float e,float w,uint end){
vec2 q=n/max(abs(n.x)+ abs(n.y),1e-30);
int turn=int((q.y>=0.0?1.0 - q.x:3.0 + q.x)*512.0 + 0.5)&2047;
int inside=int(clamp((e + EDGE_LEAST)*EDGE_STEPS + 0.5,0.0,2047.0));
int across=int(clamp(w*WIDTH_STEPS + 0.5,1.0,127.0));
return uint(turn|(inside<<11)|(across<<22))|(end<<29u);
}
struct Edges{
vec2 n;
float e;
float w;
uint end;
float stop;
};
Edges unpacked_edges(uint word){
float turn=float(int(word&2047u))/512.0,x=abs(turn - 2.0)- 1.0;
int width=int((word>>22u)&127u),end=int(word>>29u);
return Edges(normalize(vec2(x,turn<2.0?1.0 - abs(x):abs(x)- 1.0)),
float(int((word>>11u)&2047u))/EDGE_STEPS - EDGE_LEAST,width==127?128.0:float(width)/WIDTH_STEPS,
uint(end),float(end>3?end - 5:end - 2)/3.0);
}
uniform highp usampler2D texels;
uniform highp sampler2D depths;
uniform highp sampler2D drawn;
uniform float narrower;
layout(location=0)out uvec4 shown;
uint thinned(uint word){
uint inside=(word>>11u)&2047u,width=(word>>22u)&127u;
inside -=min(inside,uint(0.5*narrower*EDGE_STEPS + 0.5));
width -=min(width - 1u,uint(narrower*WIDTH_STEPS + 0.5));
return(word&0xE00007FFu)|(inside<<11u)|(width<<22u);
}
void main(){
ivec2 pixel=ivec2(gl_FragCoord.xy)- 1;
shown=uvec4(0u);
if(any(lessThan(pixel,ivec2(0)))||any(greaterThanEqual(pixel,textureSize(texels,0))))return;
uvec4 texel=texelFetch(texels,pixel,0);
bool line=texel.x!=0xFFFFFFFFu||texel.y!=0xFFFFFFFFu;
shown=uvec4(floatBitsToUint(texelFetch(depths,pixel,0).r),line?thinned(texel.z):0u,packUnorm4x8(texelFetch(drawn,pixel,0)),0u);
}
`}};var xe=O.shaders,K=O.blocks,ye=O.rotation_scales,he=O.page_bits;function L(o){let e=atob(o),n=new Uint8Array(e.length);for(let t=0;t<e.length;++t)n[t]=e.charCodeAt(t);return n}var Ae=L(O.rotations),ze=O.fields;function S(o,e){let[,n,t]=ze[o];return t===32?e:e>>>n&(1<<t)-1}var X=(o,e)=>[o[0]-e[0],o[1]-e[1],o[2]-e[2]],U=(o,e,n=1)=>[o[0]+n*e[0],o[1]+n*e[1],o[2]+n*e[2]],z=(o,e)=>[o[0]*e,o[1]*e,o[2]*e],J=(o,e)=>o[0]*e[0]+o[1]*e[1]+o[2]*e[2],Y=(o,e)=>[o[1]*e[2]-o[2]*e[1],o[2]*e[0]-o[0]*e[2],o[0]*e[1]-o[1]*e[0]],Te=o=>Math.hypot(o[0],o[1],o[2]),N=o=>z(o,1/(Te(o)||1));function F(o,e){let n=new Float64Array(16);for(let t=0;t<4;++t)for(let i=0;i<4;++i){let r=0;for(let a=0;a<4;++a)r+=o[i+4*a]*e[a+4*t];n[i+4*t]=r}return n}function ve(){let o=new Float64Array(16);return o[0]=o[5]=o[10]=o[15]=1,o}function j(o){let e=Array.from({length:4},(t,i)=>Array.from({length:8},(r,a)=>a<4?o[i+4*a]:a-4===i?1:0));for(let t=0;t<4;++t){let i=t;for(let a=t+1;a<4;++a)Math.abs(e[a][t])>Math.abs(e[i][t])&&(i=a);if(!(Math.abs(e[i][t])>0))return null;[e[t],e[i]]=[e[i],e[t]];let r=e[t][t];for(let a=0;a<8;++a)e[t][a]/=r;for(let a=0;a<4;++a){if(a===t)continue;let u=e[a][t];for(let s=0;s<8;++s)e[a][s]-=u*e[t][s]}}let n=new Float64Array(16);for(let t=0;t<4;++t)for(let i=0;i<4;++i)n[t+4*i]=e[t][i+4];return n}function M(o,e,n=1){return[0,1,2,3].map(t=>o[t]*e[0]+o[t+4]*e[1]+o[t+8]*e[2]+o[t+12]*n)}function ae(o){return[o[0],o[1],o[2],o[4],o[5],o[6],o[8],o[9],o[10]]}var oe=o=>new Float32Array(o);function pe(o,e,n){let t=n*Math.PI/180,i=Math.cos(t),r=Math.sin(t),a=N(e);return U(U(z(o,i),Y(a,o),r),a,J(a,o)*(1-i))}var re=class{constructor(e){l(this,"state",e)}get forward(){return N(X(this.state.focal_point,this.state.position))}get right(){return N(Y(this.forward,this.state.up))}get distance(){return Te(X(this.state.focal_point,this.state.position))}view(){let e=this.forward,n=this.right,t=Y(n,e),i=this.state.position;return new Float64Array([n[0],t[0],-e[0],0,n[1],t[1],-e[1],0,n[2],t[2],-e[2],0,-J(n,i),-J(t,i),J(e,i),1])}range(e){let n=this.forward,t=this.state.position,i=1/0,r=-1/0;for(let u=0;u<8;++u){let s=J(n,X([e[u&1],e[2+(u>>1&1)],e[4+(u>>2)]],t));i=Math.min(i,s),r=Math.max(r,s)}let a=Math.max(.005*(r-i),1e-6*Math.abs(r));return i-=a,r+=a,this.state.parallel?[i,Math.max(r,i+1e-6)]:(r=Math.max(r,1e-6),[Math.max(i,.001*r),r])}projection(e,n){let[t,i]=this.range(n),r=new Float64Array(16),a=this.state;if(a.parallel)r[0]=1/(a.parallel_scale*e),r[5]=1/a.parallel_scale,r[10]=-2/(i-t),r[14]=-(i+t)/(i-t),r[15]=1;else{let u=1/Math.tan(a.view_angle*Math.PI/360);r[0]=u/e,r[5]=u,r[10]=-(i+t)/(i-t),r[11]=-1,r[14]=-2*i*t/(i-t)}return r}rotate(e,n){let t=this.state,i=pe(X(t.position,t.focal_point),t.up,-200*e),r=N(Y(z(i,-1),t.up));i=pe(i,r,-200*n),t.position=U(t.focal_point,i),t.up=N(Y(r,N(z(i,-1))))}roll(e){this.state.up=pe(this.state.up,this.forward,e)}pan(e,n){let t=this.state,i=t.parallel?2*t.parallel_scale:2*this.distance*Math.tan(t.view_angle*Math.PI/360),r=Y(this.right,this.forward),a=U(z(this.right,-e*i),r,-n*i);t.position=U(t.position,a),t.focal_point=U(t.focal_point,a)}dolly(e){let n=this.state;n.parallel?n.parallel_scale/=e:n.position=U(n.focal_point,X(n.position,n.focal_point),1/e)}lookAlong(e,n,t){let i=this.state,r=[(t[0]+t[1])/2,(t[2]+t[3])/2,(t[4]+t[5])/2],a=Math.hypot(t[1]-t[0],t[3]-t[2],t[5]-t[4])/2||1,u=a/Math.sin(i.view_angle*Math.PI/360);i.focal_point=r,i.position=U(r,N(e),-u),i.up=n,i.parallel_scale=a}};function g(o,e={},...n){let t=document.createElement(o);for(let[i,r]of Object.entries(e))t.setAttribute(i,r);return t.append(...n),t}var D=o=>Number.isFinite(o)?String(Number(o.toPrecision(4))):"no value";function k(o,e,n,t,i){let r=(n-e)/200||1,a=g("output",{},D(t)),u=g("input",{type:"range",min:String(e),max:String(n),step:String(r),value:String(t)});return u.addEventListener("input",()=>{a.textContent=D(u.valueAsNumber),i(u.valueAsNumber)}),g("label",{},g("span",{},o),u,a)}function Z(o,e){let n=g("button",{type:"button"},o);return n.addEventListener("click",e),n}function Q(o,...e){return g("fieldset",{},g("legend",{},o),...e)}var Me=[["Left",[1,0,0],[0,0,1]],["Right",[-1,0,0],[0,0,1]],["Front",[0,-1,0],[0,0,1]],["Back",[0,1,0],[0,0,1]],["Top",[0,0,-1],[0,1,0]],["Bottom",[0,0,1],[0,1,0]]];function Ge(o){let e=L(o.table),n=e.length/4,t=g("canvas",{width:String(n),height:"1",role:"img","aria-label":`Colours from ${D(o.clim[0])} to ${D(o.clim[1])}`}),i=t.getContext("2d"),r=i.createImageData(n,1);r.data.set(e),i.putImageData(r,0,0);let[a,u]=o.clim,s=o.log?Math.sqrt(a*u):(a+u)/2;return g("figure",{class:"bar"},g("figcaption",{},o.title),t,g("div",{class:"ticks","aria-hidden":"true"},...[a,s,u].map(c=>g("span",{},D(c)))))}var we=class{constructor(e,n){l(this,"lines",e);l(this,"base",n);l(this,"ranges",new Map);l(this,"regions",new Map)}set(e,n,t,i){let r=this.ranges.get(e.name)??{values:n,low:e.range[0],high:e.range[1],whole:e.range};t===0?r.low=i:r.high=i,this.ranges.set(e.name,r),this.apply()}apply(){let e=[...this.ranges.values()].filter(i=>i.low>i.whole[0]||i.high<i.whole[1]);if(!e.length&&!this.regions.size)return this.lines.keep(this.base);let n=this.lines.set.streamlines,t=new Uint8Array(n);for(let i=0;i<n;++i){let r=this.base===null||this.base[i]!==0;for(let a of e){let u=1e-6*(a.whole[1]-a.whole[0]);r=r&&a.values[i]>=a.low-u&&a.values[i]<=a.high+u}for(let a of this.regions.values())r=r&&a[i]!==0;t[i]=r?1:0}this.lines.keep(t)}},se=class{constructor(e,n){l(this,"renderer",e);l(this,"data",n);l(this,"status",document.getElementById("status"));l(this,"axes",[]);l(this,"choices",new Map);l(this,"picked",null);l(this,"radius",5);let t=document.getElementById("over"),{scene:i}=e,r=g("details",{id:"panel"},g("summary",{},"Scene"));r.append(this.layers(),this.views(),this.cut(),...this.ranges(),this.region()),t.append(r),i.bars.length&&t.append(g("div",{id:"bars"},...i.bars.map(Ge))),t.append(this.orientation()),e.restored=()=>{for(let a of this.choices.values())a.apply()},e.presented=()=>this.turnAxes(),this.turnAxes()}layers(){let{renderer:e}=this,n=[];return e.scene.layers.forEach(t=>{let i=g("input",{type:"checkbox"});i.checked=t.visible,i.addEventListener("change",()=>{t.visible=i.checked,e.change()}),n.push(g("label",{},i,g("span",{},t.name))),t.kind==="fiblets"?n.push(k("Line width",.5,10,t.line_width,r=>{t.line_width=r,e.change(!0)})):n.push(k("Opacity",0,1,t.opacity,r=>{t.opacity=r,e.change(!0)}))}),Q("Shown",...n)}views(){let{renderer:e}=this,n=structuredClone(e.camera.state),t=Me.map(([i,r,a])=>Z(i,()=>{e.camera.lookAlong(r,a,e.scene.bounds),e.change()}));return t.push(Z("As at first",()=>{Object.assign(e.camera.state,structuredClone(n)),e.change()})),t.push(Z("Save picture",()=>this.save())),Q("View",g("div",{class:"buttons"},...t))}save(){let{renderer:e}=this;e.settled().then(()=>{let n=g("canvas",{width:String(e.width),height:String(e.height)}),t=n.getContext("2d"),i=t.createImageData(e.width,e.height);i.data.set(e.pixels()),t.putImageData(i,0,0),n.toBlob(r=>{let a=g("a",{href:URL.createObjectURL(r),download:"picture.png"});a.click(),setTimeout(()=>URL.revokeObjectURL(a.href),6e4)})})}cut(){let{renderer:e}=this,n=e.scene.bounds,t=g("select",{"aria-label":"Cut across"});for(let s of["nothing","left to right","back to front","bottom to top"])t.append(g("option",{},s));let i=g("div"),r=0,a=0,u=()=>{let s=t.selectedIndex-1,c=f=>[0,1,2].map(d=>d===s?f:0).concat(-f*r+a/2);e.planes=s<0?[]:[c(1),c(-1)],e.change(!0)};return t.addEventListener("change",()=>{let s=t.selectedIndex-1;if(i.replaceChildren(),s>=0){let c=n[2*s],f=n[2*s+1];r=(c+f)/2,a=(f-c)/8,i.append(k("Middle",c,f,r,d=>{r=d,u()}),k("Thickness",(f-c)/200,f-c,a,d=>{a=d,u()}))}u()}),Q("Slab across",t,i)}choiceOf(e){let n=this.choices.get(e.index);return n||this.choices.set(e.index,n=new we(e,e.layer.kept===void 0?null:this.data[e.layer.kept])),n}ranges(){let{renderer:e}=this,n=[];for(let t of e.lines){let{values:i,layer:r}=t;if(i){let a=i.code[0],u=a+i.code[1]*(i.code[2]-1),s=[a,u],c=()=>{e.lines[t.index].shownValues=s[0]>a||s[1]<u?[s[0],s[1]]:[1,0],e.change(!0)};n.push(Q(i.name,k("From",a,u,a,f=>{s[0]=f,c()}),k("To",a,u,u,f=>{s[1]=f,c()})))}for(let a of r.controls??[]){if(a.data===void 0)continue;let u=this.data[a.data],s=new Float32Array(u.slice().buffer),[c,f]=a.range,d=p=>h=>{this.choiceOf(e.lines[t.index]).set(a,s,p,h),e.change(!0)};n.push(Q(a.name,k("From",c,f,c,d(0)),k("To",c,f,f,d(1))))}}return n}region(){let{renderer:e}=this,n=e.scene.bounds,t=Math.hypot(n[1]-n[0],n[3]-n[2],n[5]-n[4]);this.radius=t/40;let i=()=>{if(!this.picked){this.status.textContent="Click on a streamline first.";return}let{lines:a,place:u}=this.picked,s=a.set.through(u,this.radius),c=this.choiceOf(a);c.regions.set("ball",s),c.apply(),e.change(),this.status.textContent=`${s.reduce((f,d)=>f+d,0)} streamlines pass within ${D(this.radius)} mm of the place`},r=()=>{for(let a of this.choices.values())a.regions.clear(),a.apply();e.change(),this.status.textContent=""};return Q("Region",k("Radius, mm",t/1e3,t/5,this.radius,a=>{this.radius=a}),g("div",{class:"buttons"},Z("Those through the picked place",i),Z("All",r)))}pick(e,n){let{renderer:t}=this,i=t.pick(e,n);for(let r of t.lines)r.marked=4294967295;if(this.picked=null,i){let{lines:r,streamline:a,value:u}=i,s=t.placeOf(r,a,e,n);r.marked=a,this.picked={lines:r,streamline:a,place:s};let c=[`Streamline ${a} of ${r.layer.name}`];u!==null&&r.values&&c.push(`${r.values.name} ${D(u)}`);for(let d of r.layer.controls??[])d.data!==void 0&&c.push(`${d.name} ${D(new Float32Array(this.data[d.data].slice().buffer)[a])}`);let f=M(r.model,s);c.push(`at ${f.slice(0,3).map(D).join(", ")} mm`),this.status.textContent=c.join("; ")}else this.status.textContent="";t.change()}orientation(){let n=(this.renderer.scene.letters?[["L","R"],["P","A"],["I","S"]]:[["","x"],["","y"],["","z"]]).flat().map((t,i)=>g("span",{class:`axis a${i>>1}`},t));return this.axes=n,g("div",{id:"axes","aria-hidden":"true"},...n)}turnAxes(){let e=this.renderer.camera.view();this.axes.forEach((n,t)=>{let i=z([0,1,2].map(s=>s===t>>1?1:0),t&1?1:-1),[r,a,u]=M(e,i,0);n.style.transform=`translate(${(r*32).toFixed(1)}px, ${(-a*32).toFixed(1)}px)`,n.style.opacity=String(.35+.65*(.5+u/2))})}};function Ie(o,e=()=>{}){let{canvas:n,camera:t}=o,i=new Map,r=0,a=0;n.addEventListener("pointerdown",s=>{n.focus(),n.setPointerCapture(s.pointerId),i.set(s.pointerId,{x:s.offsetX,y:s.offsetY}),r=0,a=s.button,s.preventDefault()}),n.addEventListener("contextmenu",s=>s.preventDefault());let u=s=>{i.delete(s.pointerId)&&(s.type==="pointerup"&&r<4&&a===0&&!i.size?e(s.offsetX,s.offsetY):o.change())};n.addEventListener("pointerup",u),n.addEventListener("pointercancel",u),n.addEventListener("pointermove",s=>{let c=i.get(s.pointerId);if(!c)return;let f=s.offsetX-c.x,d=s.offsetY-c.y,p=n.clientWidth,h=n.clientHeight;if(r+=Math.abs(f)+Math.abs(d),i.size===2){let v=[...i.entries()].find(([y])=>y!==s.pointerId)[1],_=[c.x-v.x,c.y-v.y],b=[s.offsetX-v.x,s.offsetY-v.y];t.dolly(Math.hypot(b[0],b[1])/Math.max(1,Math.hypot(_[0],_[1]))),t.roll((Math.atan2(b[1],b[0])-Math.atan2(_[1],_[0]))*180/Math.PI),t.pan(f/2/h,-d/2/h)}else a===1||s.shiftKey?t.pan(f/h,-d/h):a===2?t.dolly(Math.pow(1.1,-20*.2*d/(h/2)*5)):s.ctrlKey?t.roll(180*f/p):t.rotate(f/p,-d/h);c.x=s.offsetX,c.y=s.offsetY,o.change(!0)}),n.addEventListener("wheel",s=>{t.dolly(Math.pow(1.1,Math.max(-3,Math.min(3,-s.deltaY/50)))),o.change(!0),s.preventDefault()},{passive:!1}),n.addEventListener("keydown",s=>{let f={ArrowLeft:()=>s.shiftKey?t.pan(-.04,0):t.rotate(-.04,0),ArrowRight:()=>s.shiftKey?t.pan(.04,0):t.rotate(.04,0),ArrowUp:()=>s.shiftKey?t.pan(0,.04):t.rotate(0,.04),ArrowDown:()=>s.shiftKey?t.pan(0,-.04):t.rotate(0,-.04),"+":()=>t.dolly(1.1),"=":()=>t.dolly(1.1),"-":()=>t.dolly(.9090909090909091),Enter:()=>e(n.clientWidth/2,n.clientHeight/2)};s.altKey||s.metaKey||!f[s.key]||(f[s.key](),o.change(!0),s.preventDefault())})}var x=class extends Error{},Ve=101010256,Ye=101075792,Qe=117853008,He=33639248,qe=67324752,We="header.json";function H(o,e){return o.getUint32(e,!0)+o.getUint32(e+4,!0)*4294967296}function Ke(o){let e=o.byteLength;for(let n=e-22;n>=Math.max(0,e-65558);--n)if(o.getUint32(n,!0)===Ve){if(n>=20&&o.getUint32(n-20,!0)===Qe){let t=H(o,n-12);if(t+56<=e&&o.getUint32(t,!0)===Ye)return[H(o,t+48),H(o,t+32)]}return[o.getUint32(n+16,!0),o.getUint16(n+10,!0)]}throw new x("This is no whole .fiblets file: the end of its zip archive is missing. Copy or make it again.")}function Xe(o,e,n,t){let i=o.getUint32(e+24,!0),r=o.getUint32(e+42,!0),a=o.getUint32(e+20,!0);for(let u=e+46+n,s=u+t;u+4<=s;){let c=o.getUint16(u,!0),f=o.getUint16(u+2,!0),d=u+4;c===1&&(i===4294967295&&(i=H(o,d),d+=8),a===4294967295&&(a=H(o,d),d+=8),r===4294967295&&(r=H(o,d))),u+=4+f}return[i,r]}var Je={"|u1":[1,Uint8Array],"|i1":[1,Int8Array],"|b1":[1,Uint8Array],"<u2":[2,Uint16Array],"<i2":[2,Int16Array],"<u4":[4,Uint32Array],"<i4":[4,Int32Array],"<f4":[4,Float32Array],"<f8":[8,Float64Array],"<i8":[8,BigInt64Array],"<u8":[8,BigUint64Array]};function je(o,e){let n=new x(`The member ${e} of the file is damaged. Copy or make the file again.`);if(o.length<10||o[0]!==147||o[6]!==1)throw n;let t=o[8]|o[9]<<8,i=new TextDecoder("latin1").decode(o.subarray(10,10+t)),r=/'descr':\s*'([^']+)'/.exec(i),a=/'shape':\s*\(([^)]*)\)/.exec(i);if(!r||!a||/'fortran_order':\s*True/.test(i))throw n;let u=Je[r[1]];if(!u)return null;let s=a[1].split(",").map(h=>h.trim()).filter(h=>h).map(Number),c=s.reduce((h,v)=>h*v,1),f=o.byteOffset+10+t;if(!s.every(h=>Number.isSafeInteger(h)&&h>=0)||10+t+c*u[0]>o.length)throw n;let d=o.buffer,p=f%u[0]===0?new u[1](d,f,c):new u[1](d.slice(f,f+c*u[0]),0,c);return{shape:s,data:p}}function Fe(o){let e=new DataView(o.buffer,o.byteOffset,o.byteLength);if(o.length<22)throw new x("This is no .fiblets file: it is empty, or cut short.");let[n,t]=Ke(e),i=new Map,r=null,a=n;for(let u=0;u<t;++u){if(a+46>o.length||e.getUint32(a,!0)!==He)throw new x("The list of the file's members is damaged. Copy or make the file again.");let s=e.getUint16(a+28,!0),c=e.getUint16(a+30,!0),f=e.getUint16(a+32,!0),d=new TextDecoder().decode(o.subarray(a+46,a+46+s)),[p,h]=Xe(e,a,s,c);if(e.getUint16(a+10,!0)!==0)throw new x(`The member ${d} of the file is compressed; .fiblets files store their members as they are.`);if(h+30>o.length||e.getUint32(h,!0)!==qe)throw new x(`The member ${d} of the file is damaged. Copy or make the file again.`);let v=h+30+e.getUint16(h+26,!0)+e.getUint16(h+28,!0);if(v+p>o.length)throw new x(`The file ends within its member ${d}. Copy or make it again.`);let _=o.subarray(v,v+p);if(d===We)try{r=JSON.parse(new TextDecoder().decode(_))}catch{throw new x("The file's header is damaged. Copy or make the file again.")}else{let b=je(_,d);b&&i.set(d,b)}a+=46+s+c+f}if(r===null||typeof r!="object")throw new x("This is a zip archive, but no .fiblets file: it has no header.json.");return{header:r,arrays:i}}var G=4096,q=class extends Error{};function Ze(o,e){return xe[o].replace(/#define FEATURE_(\w+) [01]/g,(n,t)=>`#define FEATURE_${t} ${e.includes(t)?1:0}`)}var W=class{constructor(e,n,t,i=[],r=[]){l(this,"gl",e);l(this,"handle");l(this,"places",new Map);l(this,"units",new Map);this.handle=e.createProgram();let a=[[e.VERTEX_SHADER,n],[e.FRAGMENT_SHADER,t]].map(([u,s])=>{let c=e.createShader(u);return e.shaderSource(c,Ze(s,i)),e.compileShader(c),e.attachShader(this.handle,c),[s,c]});if(r.length&&e.transformFeedbackVaryings(this.handle,r,e.INTERLEAVED_ATTRIBS),e.linkProgram(this.handle),!e.getProgramParameter(this.handle,e.LINK_STATUS)&&!e.isContextLost()){let u=a.map(([s,c])=>`${s}: ${e.getShaderInfoLog(c)}`).join("; ");throw new q(`This browser's graphics cannot run the page's programs: ${e.getProgramInfoLog(this.handle)} ${u}`)}Object.keys(K).forEach((u,s)=>{let c=e.getUniformBlockIndex(this.handle,u);c!==e.INVALID_INDEX&&e.uniformBlockBinding(this.handle,c,s)})}use(){return this.gl.useProgram(this.handle),this}at(e){return this.places.has(e)||this.places.set(e,this.gl.getUniformLocation(this.handle,e)),this.places.get(e)}set(e){let n=this.gl;for(let[t,i]of Object.entries(e)){let r=this.at(t);r!==null&&(typeof i=="number"?n.uniform1f(r,i):i.length===2?n.uniform2fv(r,i):i.length===3?n.uniform3fv(r,i):i.length===4?n.uniform4fv(r,i):i.length===9?n.uniformMatrix3fv(r,!1,i):n.uniformMatrix4fv(r,!1,i))}return this}ints(e){for(let[n,t]of Object.entries(e)){let i=this.at(n);i!==null&&this.gl.uniform1i(i,t)}return this}uints(e){for(let[n,t]of Object.entries(e)){let i=this.at(n);i!==null&&this.gl.uniform1ui(i,t)}return this}textures(e){let n=this.gl;for(let[t,i]of Object.entries(e)){let r=this.at(t);if(r===null)continue;this.units.has(t)||this.units.set(t,this.units.size);let a=this.units.get(t);n.activeTexture(n.TEXTURE0+a),n.bindTexture(n.TEXTURE_2D,i),n.uniform1i(r,a)}return this}},$e={r8ui:["R8UI","RED_INTEGER","UNSIGNED_BYTE",1,Uint8Array],r16ui:["R16UI","RED_INTEGER","UNSIGNED_SHORT",1,Uint16Array],r32ui:["R32UI","RED_INTEGER","UNSIGNED_INT",1,Uint32Array],rg32ui:["RG32UI","RG_INTEGER","UNSIGNED_INT",2,Uint32Array],rgba32ui:["RGBA32UI","RGBA_INTEGER","UNSIGNED_INT",4,Uint32Array],rgba8:["RGBA8","RGBA","UNSIGNED_BYTE",4,Uint8Array]};function Re(o){for(let e of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])o.texParameteri(o.TEXTURE_2D,o[e],o.NEAREST);for(let e of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])o.texParameteri(o.TEXTURE_2D,o[e],o.CLAMP_TO_EDGE)}function R(o,e,n,t){let[i,r,a,u,s]=$e[e],c=Math.ceil(n.length/u),f=Math.max(1,Math.ceil(c/G));if(f>o.getParameter(o.MAX_TEXTURE_SIZE))throw new q(`The ${t} have ${c} texels; this device's textures hold ${o.getParameter(o.MAX_TEXTURE_SIZE)*G}. Make a page of fewer streamlines.`);let d=o.createTexture();o.bindTexture(o.TEXTURE_2D,d),Re(o),o.pixelStorei(o.UNPACK_ALIGNMENT,1),o.texStorage2D(o.TEXTURE_2D,1,o[i],G,f);let p=Math.floor(c/G),h=G*u;for(let v=0;v<p;v+=256){let _=Math.min(256,p-v);o.texSubImage2D(o.TEXTURE_2D,0,0,v,G,_,o[r],o[a],n.subarray(v*h,(v+_)*h))}if(p<f){let v=new s(h);v.set(n.subarray(p*h)),o.texSubImage2D(o.TEXTURE_2D,0,0,p,G,1,o[r],o[a],v)}return d}function ue(o,e,n,t){let i=e.length/4-3,[r,a]=t?n.map(u=>Math.log10(u)):n;return[R(o,"rgba8",e,"colours"),[r,a,i/Math.max(a-r,1e-30),i]]}function $(o,e,n,t){let i=o.createTexture();return o.bindTexture(o.TEXTURE_2D,i),Re(o),o.texStorage2D(o.TEXTURE_2D,1,e,n,t),i}function ee(o,e,n){let t=o.createFramebuffer();return o.bindFramebuffer(o.FRAMEBUFFER,t),o.framebufferTexture2D(o.FRAMEBUFFER,o.COLOR_ATTACHMENT0,o.TEXTURE_2D,e,0),n&&o.framebufferTexture2D(o.FRAMEBUFFER,o.DEPTH_ATTACHMENT,o.TEXTURE_2D,n,0),t}var C=class{constructor(e,n){l(this,"gl",e);l(this,"name",n);l(this,"bytes");l(this,"floats");l(this,"words");l(this,"buffer");l(this,"binding");this.bytes=new ArrayBuffer(K[n].bytes),this.floats=new Float32Array(this.bytes),this.words=new Uint32Array(this.bytes),this.buffer=e.createBuffer(),this.binding=Object.keys(K).indexOf(n),e.bindBuffer(e.UNIFORM_BUFFER,this.buffer),e.bufferData(e.UNIFORM_BUFFER,this.bytes.byteLength,e.DYNAMIC_DRAW)}write(e,n=[]){for(let[t,i]of Object.entries(e)){let r=K[this.name].fields[t]/4,a=n.includes(t)?this.words:this.floats;typeof i=="number"?a[r]=i:a.set(i,r)}this.upload()}fill(e){new Uint8Array(this.bytes).set(e),this.upload()}upload(){this.gl.bindBuffer(this.gl.UNIFORM_BUFFER,this.buffer),this.gl.bufferSubData(this.gl.UNIFORM_BUFFER,0,new Uint8Array(this.bytes))}bind(){this.gl.bindBufferBase(this.gl.UNIFORM_BUFFER,this.binding,this.buffer)}};var en=4096,P=20,V=12,Be=P*V,nn=0,tn=3;function Le(o,e,n,t){if(!o||!(o.data instanceof Uint32Array)||o.data.length!==n*t)throw new x(`The file's ${e} do not fit its header. Copy or make it again.`);return o.data}var ne=class{constructor(e,n){l(this,"gl",e);l(this,"archive",n);l(this,"blocks",[]);l(this,"streamlines");l(this,"points");l(this,"bounds");l(this,"reference");l(this,"toData");l(this,"coding");l(this,"items");l(this,"budget",256<<20);l(this,"parameters");l(this,"decodeProgram");l(this,"rotationBlock");l(this,"frameForDecoding");l(this,"textures",{});l(this,"itemBuffer");l(this,"toItems");l(this,"feedback");l(this,"scratch",null);l(this,"scratchBytes",0);l(this,"held",0);l(this,"clock",0);l(this,"fiblets");l(this,"decodeArray");l(this,"segments",null);let{header:t,arrays:i}=n;if(t.format!=="fiblets")throw new x("The file is no .fiblets file: its header says something else.");if(t.version!==2)throw new x(`The file is of version ${t.version}; this page reads version 2. Make the page again with a newer pvfiblets.`);let r=this.parameters=t.parameters,a=this.fiblets=t.n_fiblets;this.streamlines=t.n_streamlines,this.points=t.n_points,this.bounds=t.bounds;let u=Le(i.get("anchors.npy"),"anchors",2,a),s=Le(i.get("decoding.npy"),"records",3,a),c=i.get("codes.npy"),f=i.get("pages.npy");if(!c||!(c.data instanceof Uint8Array)||!f||!(f.data instanceof BigInt64Array))throw new x("The file's codes or pages are missing. Copy or make it again.");let d=Array.from(f.data,Number),p=Math.ceil(a/(1<<he));if(d.length!==3*(p+1)||d[3*p+1]!==c.data.length||d[3*p+2]!==this.points)throw new x("The file's table of pages does not fit its records. Copy or make it again.");let h=r.anchor_bits===32?i.get("anchors_low.npy"):void 0;if(r.anchor_bits===32&&!(h?.data instanceof Uint16Array&&h.data.length===3*a))throw new x("The lower halves of the file's anchors are missing. Copy or make it again.");let v=r.anchor_bits===32?4294967295:65535;this.reference=[0,1,2].map(m=>{let T=(this.bounds[2*m]+this.bounds[2*m+1])/2,B=r.anchor_scale[m];return B>0&&Number.isFinite(T)?Math.round(Math.min(Math.max((T-r.origin[m])/B,0),v)):0}),this.toData=new Float64Array([1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]);for(let m=0;m<3;++m)this.toData[12+m]=r.origin[m]+r.anchor_scale[m]*this.reference[m];let _=this.makeItems(u,s,d,c.data.length,h?.data);this.items=this.textures.items,this.textures.anchor_texels=R(e,"rg32ui",u,"anchors"),this.textures.decoding_texels=R(e,"r32ui",s,"records");let b=c.data.byteOffset%4===0?c.data:c.data.slice(),y=b.length>>2,E=new Uint32Array(b.buffer,b.byteOffset,y);this.textures.code_texels=this.codeTexture(E,b.subarray(4*y));let w=new Uint32Array(4*Math.max(p,1));for(let m=0;m<p;++m)for(let T=0;T<3;++T)w[4*m+T]=d[3*m+T];this.textures.page_texels=R(e,"rgba32ui",w,"pages");let A=["DIRECTION"];if(h){A.push("ANCHORS_LOW");let m=h.data,T=new Uint32Array(m.length+1>>1);for(let B=0;B<m.length;++B)T[B>>1]|=m[B]<<16*(B&1);this.textures.anchor_low_texels=R(e,"r32ui",T,"anchors")}(_.size>1||!_.has(nn))&&A.push("LATTICE"),_.has(tn)&&A.push("WIDE_LATTICE"),this.coding=new C(e,"Coding"),this.coding.write({anchor_scale:r.anchor_scale,radius_scale:0,step_low:r.step_lo,step_span:r.step_hi-r.step_lo,lattice_edge:r.lattice,end_vector_scale:0,rotation_scales:ye}),this.rotationBlock=new C(e,"Rotations"),this.rotationBlock.fill(Ae),this.frameForDecoding=new C(e,"Frame"),this.frameForDecoding.write({reference:this.reference},["reference"]),this.decodeProgram=new W(e,"page/decode.vert","page/none.frag",A,Array.from({length:15},(m,T)=>`o${T}`)),this.feedback=e.createTransformFeedback(),this.decodeArray=e.createVertexArray(),e.bindVertexArray(this.decodeArray),e.enableVertexAttribArray(0),e.bindVertexArray(null)}codeTexture(e,n){if(!n.length)return R(this.gl,"r32ui",e,"codes");let t=new Uint32Array(e.length+1);t.set(e);for(let i=0;i<n.length;++i)t[e.length]|=n[i]<<8*i;return R(this.gl,"r32ui",t,"codes")}makeItems(e,n,t,i,r){let a=this.gl,u=this.fiblets,s=this.parameters,c=this.archive.arrays.get("rank_to_id.npy")?.data,f=new Uint8Array(u),d=0;for(let w=0;w<u;++w){let A=S("last",n[3*w+2])+1;f[w]=A%P===0&&!(e[2*w+1]>>>31)?A/P:Math.ceil((A+2)/P),d+=f[w]}let p=new Uint32Array(4*Math.max(d,1)),h=new Uint32Array(2*Math.max(d,1)),v=new Set,_=2*s.largest_radius,b=0,y=0,E=null;for(let w=0;w<u;++w){let A=3*(w>>he),m=e[2*w+1],T=n[3*w+2],B=S("rank",m)+t[A],ie=S("last",T)+1,de=c?Number(c[B]):B,me=S("begin",m),Ce=S("end",m),Ue=S("code",n[3*w+1])+t[A+1],_e=S("point",T)+t[A+2];if(ie>60||!(de>=0&&de<this.streamlines)||Ue>i||_e+ie>this.points)throw new x(`Record ${w} of the file is damaged. Copy or make it again.`);v.add(S("kind",T)),w%en===0&&this.blocks.push(E={firstItem:b,items:0,more:0,bounds:[1/0,-1/0,1/0,-1/0,1/0,-1/0],buffer:null,used:0});let ge=[e[2*w]&65535,e[2*w]>>>16,m&65535];for(let I=0;I<3;++I){let Ee=s.origin[I]+s.anchor_scale[I]*(r?ge[I]*65536+r[3*w+I]:ge[I]);E.bounds[2*I]=Math.min(E.bounds[2*I],Ee-_),E.bounds[2*I+1]=Math.max(E.bounds[2*I+1],Ee+_)}me&&(y=0);for(let I=0;I<f[w];++I,++b)p[4*b]=de,p[4*b+1]=_e,p[4*b+2]=ie|me<<6|Ce<<7|I<<8,p[4*b+3]=y,h[2*b]=w,h[2*b+1]=I;y+=ie,E.items+=f[w]}for(let w of this.blocks)w.more=w.firstItem+w.items<d?1:0;return this.toItems=p,this.textures.items=R(a,"rgba32ui",p,"shares of fiblets"),this.itemBuffer=a.createBuffer(),a.bindBuffer(a.ARRAY_BUFFER,this.itemBuffer),a.bufferData(a.ARRAY_BUFFER,h,a.STATIC_DRAW),v}pointValues(e){let n=this.archive.header.per_point?.[e],t=n&&this.archive.arrays.get(n.member);if(!t||t.data.length!==this.points)throw new x(`The file has no values ${e} for its points.`);let i=t.data instanceof Uint16Array,r=i?65535:255;return{name:e,texture:R(this.gl,i?"r16ui":"r8ui",t.data,"values of points"),code:[n.lo,(n.hi-n.lo)/(r-1),r]}}decode(e,n){let t=this.gl,i=e.items+e.more;this.coding.bind(),this.rotationBlock.bind(),this.frameForDecoding.bind();let{items:r,...a}=this.textures;this.decodeProgram.use().textures(a).uints({chunk_fiblets:this.fiblets}),t.bindVertexArray(this.decodeArray),t.bindBuffer(t.ARRAY_BUFFER,this.itemBuffer),t.vertexAttribIPointer(0,2,t.UNSIGNED_INT,8,8*e.firstItem),t.bindBuffer(t.ARRAY_BUFFER,null),t.enable(t.RASTERIZER_DISCARD),t.bindTransformFeedback(t.TRANSFORM_FEEDBACK,this.feedback),t.bindBufferRange(t.TRANSFORM_FEEDBACK_BUFFER,0,n,V,i*Be),t.beginTransformFeedback(t.POINTS),t.drawArrays(t.POINTS,0,i),t.endTransformFeedback(),t.bindBufferBase(t.TRANSFORM_FEEDBACK_BUFFER,0,null),t.bindTransformFeedback(t.TRANSFORM_FEEDBACK,null),t.disable(t.RASTERIZER_DISCARD),t.bindVertexArray(null)}size(e){return V+(e.items+e.more)*Be+3*V}newBuffer(e){let n=this.gl,t=n.createBuffer();return n.bindBuffer(n.ARRAY_BUFFER,t),n.bufferData(n.ARRAY_BUFFER,e,n.DYNAMIC_COPY),n.bindBuffer(n.ARRAY_BUFFER,null),t}pointsOf(e){if(e.used=++this.clock,e.buffer)return e.buffer;let n=this.size(e);return this.held+n<=this.budget?(this.held+=n,e.buffer=this.newBuffer(n),this.decode(e,e.buffer),e.buffer):(this.scratchBytes<n&&(this.scratch&&this.gl.deleteBuffer(this.scratch),this.scratch=this.newBuffer(this.scratchBytes=n)),this.decode(e,this.scratch),this.scratch)}static instances(e){return e.items*P}draw(e,n,t){let i=this.gl,r=this.pointsOf(e);n.use().ints({first_item:e.firstItem}),i.bindVertexArray(this.segmentArray()),i.bindBuffer(i.ARRAY_BUFFER,r);for(let u=0;u<4;++u)i.vertexAttribPointer(u,3,i.FLOAT,!1,V,u*V);let a=Math.max(1,Math.round(e.items*t))*P;return i.drawArraysInstanced(i.TRIANGLE_STRIP,0,4,a),i.bindVertexArray(null),a}segmentArray(){if(!this.segments){let e=this.gl;this.segments=e.createVertexArray(),e.bindVertexArray(this.segments);for(let n=0;n<4;++n)e.enableVertexAttribArray(n),e.vertexAttribDivisor(n,1)}return this.segments}*decoded(e){let n=this.gl,t=this.toItems;for(let i of this.blocks){if(!e(i))continue;let r=new Float32Array((i.items+i.more)*P*3);n.bindBuffer(n.ARRAY_BUFFER,this.pointsOf(i)),n.getBufferSubData(n.ARRAY_BUFFER,V,r),n.bindBuffer(n.ARRAY_BUFFER,null);for(let a=i.firstItem;a<i.firstItem+i.items;++a){if(t[4*a+2]>>>8)continue;let u=t[4*a+2]&63,s=(t[4*a+2]&128)!==0,c=3*P*(a-i.firstItem);yield[t[4*a],r.subarray(c,c+3*(u+(s?0:1))),(t[4*a+2]&64)!==0]}}}blocksOf(e){let n=this.toItems;return t=>{for(let i=t.firstItem;i<t.firstItem+t.items;++i)if(n[4*i]===e)return!0;return!1}}world(e,n){return[0,1,2].map(t=>this.toData[12+t]+e[3*n+t])}pointsOfStreamline(e){let n=[];for(let[t,i]of this.decoded(this.blocksOf(e)))if(t===e)for(let r=0;3*r<i.length;++r)n.push(this.world(i,r));return n}through(e,n){let t=new Uint8Array(this.streamlines),i=[0,1,2].map(u=>e[u]-this.toData[12+u]),r=n*n,a=u=>[0,1,2].every(s=>e[s]+n>=u.bounds[2*s]&&e[s]-n<=u.bounds[2*s+1]);for(let[u,s]of this.decoded(a))if(!t[u])for(let c=0;c<s.length;c+=3){let f=Math.min(c+3,s.length-3),d=s[f]-s[c],p=s[f+1]-s[c+1],h=s[f+2]-s[c+2],v=i[0]-s[c],_=i[1]-s[c+1],b=i[2]-s[c+2],y=Math.min(1,Math.max(0,(v*d+_*p+b*h)/(d*d+p*p+h*h||1))),E=v-y*d,w=_-y*p,A=b-y*h;if(E*E+w*w+A*A<=r){t[u]=1;break}}return t}release(){let e=this.gl;for(let n of this.blocks)n.buffer&&e.deleteBuffer(n.buffer);for(let n of Object.values(this.textures))e.deleteTexture(n);this.scratch&&e.deleteBuffer(this.scratch),e.deleteBuffer(this.itemBuffer)}};function rn(o,e,n){let t=e.slice(0,6).map(i=>[0,1,2,3].map(r=>i[0]*n[4*r]+i[1]*n[4*r+1]+i[2]*n[4*r+2]+i[3]*n[4*r+3]));o.ints({plane_count:t.length}),t.forEach((i,r)=>o.set({[`planes[${r}]`]:i}))}var ce=class{constructor(e,n,t){l(this,"gl",e);l(this,"layer",n);l(this,"array");l(this,"buffers",[]);l(this,"count");l(this,"table",null);l(this,"tableRange",[0,1,1,1]);l(this,"model");this.model=new Float64Array(n.matrix??[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]),this.array=e.createVertexArray(),e.bindVertexArray(this.array);let i=(a,u,s,c,f)=>{let d=e.createBuffer();e.bindBuffer(e.ARRAY_BUFFER,d),e.bufferData(e.ARRAY_BUFFER,u,e.STATIC_DRAW),e.enableVertexAttribArray(a),e.vertexAttribPointer(a,s,c,f,0,0),this.buffers.push(d)};i(0,t[n.places],3,e.FLOAT,!1),n.normals!==void 0&&i(1,t[n.normals],3,e.FLOAT,!1),n.colours!==void 0&&i(2,t[n.colours],4,e.UNSIGNED_BYTE,!0),n.values!==void 0&&(i(3,t[n.values],1,e.FLOAT,!1),[this.table,this.tableRange]=ue(e,L(n.table),n.clim,!!n.log));let r=e.createBuffer();e.bindBuffer(e.ELEMENT_ARRAY_BUFFER,r),e.bufferData(e.ELEMENT_ARRAY_BUFFER,t[n.triangles],e.STATIC_DRAW),this.buffers.push(r),this.count=t[n.triangles].byteLength/4,e.bindVertexArray(null)}get translucent(){return this.layer.opacity<1}draw(e,n){let t=this.gl,{layer:i}=this,r=F(n.view,this.model),a=ae(r),u=j(r),s=u?[u[0],u[4],u[8],u[1],u[5],u[9],u[2],u[6],u[10]]:a;e.use().set({clip_from_data:oe(F(n.projection,r)),view_from_data:oe(r),normal_to_view:s,parallel:n.parallel?1:0,opacity:i.opacity,reflects:i.reflects,sheen:i.sheen}),e.ints({smooth_normals:i.normals===void 0?0:1,lighting:i.lighting?1:0,by_value:this.table?1:0,logarithm:i.log?1:0}),e.textures({table:this.table}).set({table_range:this.tableRange}),n.lights(e),rn(e,[...i.planes??[],...n.planes],this.model),t.bindVertexArray(this.array),i.normals===void 0&&t.vertexAttrib3f(1,0,0,1),i.colours===void 0&&t.vertexAttrib4f(2,i.colour[0],i.colour[1],i.colour[2],1),t.drawElements(t.TRIANGLES,this.count,t.UNSIGNED_INT,0),t.bindVertexArray(null)}depth(e){let n=this.layer.bounds,t=[(n[0]+n[1])/2,(n[2]+n[3])/2,(n[4]+n[5])/2];return-(e[2]*t[0]+e[6]*t[1]+e[10]*t[2]+e[14])}},le=class{constructor(e,n,t){l(this,"gl",e);l(this,"layer",n);l(this,"texture");let[i,r]=n.size;this.texture=e.createTexture(),e.bindTexture(e.TEXTURE_2D,this.texture),e.texImage2D(e.TEXTURE_2D,0,e.RGBA8,i,r,0,e.RGBA,e.UNSIGNED_BYTE,t[n.pixels]);for(let a of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])e.texParameteri(e.TEXTURE_2D,e[a],e.NEAREST);for(let a of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])e.texParameteri(e.TEXTURE_2D,e[a],e.CLAMP_TO_EDGE)}draw(e,n){let{layer:t}=this;e.use().set({clip_from_data:oe(F(n.projection,n.view)),corner:t.corner,across:t.across,up:t.up,opacity:t.opacity}),e.textures({pixels:this.texture}),this.gl.bindVertexArray(null),this.gl.drawArrays(this.gl.TRIANGLE_STRIP,0,4)}};var an=60,Se=45,on=150,te=4294967295,sn={direction:0,solid:1,streamline:2,value:3,point:4},un={none:0,line:1,illuminated:2},be=class{constructor(e,n,t,i){l(this,"gl",e);l(this,"layer",n);l(this,"index",t);l(this,"set");l(this,"model");l(this,"values",null);l(this,"colours",null);l(this,"table",null);l(this,"tableRange",[0,1,1,1]);l(this,"kept",null);l(this,"shownValues",[1,0]);l(this,"marked",te);this.set=new ne(e,Fe(i[n.data])),this.model=new Float64Array(n.matrix??ve());let{colours:r}=n;r.values!==void 0&&(this.values=this.set.pointValues(r.values)),r.data!==void 0&&(this.colours=R(e,"rgba8",i[r.data],"colours")),r.table!==void 0&&([this.table,this.tableRange]=ue(e,L(r.table),r.clim,!!r.log)),n.kept!==void 0&&this.keep(i[n.kept])}get byPoint(){return this.layer.colours.mode==="point"}keep(e){this.kept&&this.gl.deleteTexture(this.kept),this.kept=e&&R(this.gl,"r8ui",e,"streamlines")}},fe=class{constructor(e,n,t){l(this,"canvas",e);l(this,"scene",n);l(this,"data",t);l(this,"camera");l(this,"lines",[]);l(this,"surfaces",[]);l(this,"images",[]);l(this,"planes",[]);l(this,"width",0);l(this,"height",0);l(this,"ratio",1);l(this,"frames",0);l(this,"failed",null);l(this,"drawnOnce",null);l(this,"presented",null);l(this,"gl");l(this,"programs",new Map);l(this,"frameBlock");l(this,"clipBlock");l(this,"textures",{});l(this,"buffers",{});l(this,"frame",null);l(this,"sync",null);l(this,"sliceStarted",0);l(this,"sliceSize",0);l(this,"rate",1e3);l(this,"dirty",!0);l(this,"moving",!1);l(this,"asked",0);l(this,"still",0);l(this,"waiting",[]);l(this,"restored",null);this.camera=new re(structuredClone(n.camera));let i=e.getContext("webgl2",{alpha:!1,antialias:!1,depth:!1,preserveDrawingBuffer:!1,powerPreference:"high-performance"});if(!i)throw new q("This browser has no WebGL 2, which the page draws with. Turn on graphics acceleration in its settings, or open the page in another browser.");this.gl=i,e.addEventListener("webglcontextlost",r=>{r.preventDefault(),this.frame=null,this.sync=null}),e.addEventListener("webglcontextrestored",()=>this.guarded(()=>this.begin())),this.begin()}guarded(e){try{e()}catch(n){this.gl.isContextLost()||this.failed?.(n)}}begin(){let{gl:e,scene:n}=this,t=this.lines.splice(0);this.programs.clear(),this.textures={},this.buffers={},this.width=this.height=0,this.surfaces.length=this.images.length=0,this.frameBlock=new C(e,"Frame"),this.clipBlock=new C(e,"ClipPlanes"),n.layers.forEach(r=>{r.kind==="surface"?this.surfaces.push(new ce(e,r,this.data)):r.kind==="image"?this.images.push(new le(e,r,this.data)):this.lines.push(new be(e,r,this.lines.length,this.data))});let i=Math.min(1024,128*(navigator.deviceMemory??4))*2**20;for(let r of this.lines)r.set.budget=i/this.lines.length;t.forEach((r,a)=>{let u=this.lines[a];u.shownValues=r.shownValues,u.marked=r.marked}),this.restored?.(),this.change()}program(e,n,t=[]){let i=[e,n,...t].join(" "),r=this.programs.get(i);return r||this.programs.set(i,r=new W(this.gl,e,n,t)),r}change(e=!1){this.dirty=!0,this.moving=e,window.clearTimeout(this.still),e&&(this.still=window.setTimeout(()=>this.change(),200)),this.schedule()}schedule(){this.asked||(this.asked=requestAnimationFrame(()=>this.guarded(()=>this.tick())))}settled(){return!this.dirty&&!this.frame?Promise.resolve():new Promise(e=>this.waiting.push(e))}tick(){this.asked=0;let{gl:e}=this;if(e.isContextLost())return;if(this.sync){if(e.getSyncParameter(this.sync,e.SYNC_STATUS)!==e.SIGNALED)return this.schedule();e.deleteSync(this.sync),this.sync=null;let r=Math.max(performance.now()-this.sliceStarted,.5);this.sliceSize>2e3&&(this.rate+=.5*(Math.min(this.sliceSize/r,8*this.rate)-this.rate))}this.fit(),this.dirty&&this.start();let n=this.frame;if(!n)return;let t=this.rate*(n.moving?Se:an);this.sliceStarted=performance.now(),this.sliceSize=0,this.drawSlice(n,n.moving?1/0:t);let i=n.next>=n.jobs.length;(i||performance.now()-n.shownAt>on)&&(n.shownAt=performance.now(),this.present(n.matrices)),this.sync=e.fenceSync(e.SYNC_GPU_COMMANDS_COMPLETE,0),e.flush(),i&&(this.frame=null,++this.frames,this.drawnOnce&&(this.drawnOnce(),this.drawnOnce=null),!n.moving&&!this.dirty&&this.waiting.splice(0).forEach(r=>r())),this.schedule()}fit(){let{gl:e,canvas:n}=this,t=window.devicePixelRatio||1,i=e.getParameter(e.MAX_TEXTURE_SIZE)-2,r=Math.min(i,Math.max(1,Math.round(n.clientWidth*t))),a=Math.min(i,Math.max(1,Math.round(n.clientHeight*t)));if(r===this.width&&a===this.height)return;n.width=this.width=r,n.height=this.height=a,this.ratio=t;for(let s of Object.values(this.textures))e.deleteTexture(s);for(let s of Object.values(this.buffers))e.deleteFramebuffer(s);let u=this.textures={texels:$(e,e.RGBA32UI,r,a),depths:$(e,e.DEPTH_COMPONENT32F,r,a),drawn:$(e,e.RGBA8,r,a),shown:$(e,e.RGBA32UI,r+2,a+2)};this.buffers={texels:ee(e,u.texels,u.depths),scene:ee(e,u.drawn,u.depths),drawn:ee(e,u.drawn,null),shown:ee(e,u.shown,null)},this.dirty=!0}start(){let{gl:e,camera:n,scene:t}=this,i=this.moving;this.dirty=!1;let r=n.view(),a=n.projection(this.width/this.height,t.bounds),u={view:r,projection:a,parallel:n.state.parallel,lights:d=>this.setLights(d,r),planes:this.planes},s=[],c=0;for(let d of this.lines)if(d.layer.visible)for(let p of d.set.blocks)this.outside(F(a,F(r,d.model)),p.bounds)||(s.push({lines:d,block:p}),c+=ne.instances(p));let f=i?Math.min(1,this.rate*Se/Math.max(c,1)):1;this.frame={jobs:s,next:0,share:f,drawn:0,shownAt:performance.now(),matrices:u,moving:i},this.frames||(this.frame.shownAt=0),e.viewport(0,0,this.width,this.height),e.disable(e.BLEND),e.disable(e.CULL_FACE),e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.texels),e.clearBufferuiv(e.COLOR,0,[te,te,0,0]),e.depthMask(!0),e.clearBufferfv(e.DEPTH,0,[1]),this.drawBackdrop(u)}drawBackdrop(e){let{gl:n,scene:t}=this;n.bindFramebuffer(n.FRAMEBUFFER,this.buffers.scene),n.disable(n.DEPTH_TEST),n.bindVertexArray(null),this.program("page/screen.vert","page/background.frag").use().set({bottom:t.background[0],top:t.background[1],height:this.height}),n.drawArrays(n.TRIANGLES,0,3),n.enable(n.DEPTH_TEST),n.depthFunc(n.LEQUAL),n.depthMask(!0);let i=this.program("page/surface.vert","page/surface.frag");for(let a of this.surfaces)a.layer.visible&&!a.translucent&&a.draw(i,e);let r=this.program("page/image.vert","page/image.frag");for(let a of this.images)a.layer.visible&&a.layer.opacity>=1&&a.draw(r,e)}outside(e,n){let t=[0,0,0,0,0,0];for(let i=0;i<8;++i){let[r,a,u,s]=M(e,[n[i&1],n[2+(i>>1&1)],n[4+(i>>2)]]);[r<-s,r>s,a<-s,a>s,u<-s,u>s].forEach((c,f)=>t[f]+=c?1:0)}return t.some(i=>i===8)}setLights(e,n){let t=[0,0,0],i=0;this.scene.lights.slice(0,8).forEach((r,a)=>{let u=[0,0,1,0];r.view?u=[...r.view,0]:r.world&&(i=1,u=M(n,r.world,r.positional?1:0),u[3]=r.positional?1:0),e.set({[`light_colour[${a}]`]:r.colour,[`light_place[${a}]`]:u}),r.colour.forEach((s,c)=>t[c]+=s)}),e.ints({light_count:Math.min(this.scene.lights.length,8)}).set({light_sum:t,light_standing:i})}aim(e,n){let t=e.layer.line_width*this.ratio,i=t>1,r=F(n.view,F(e.model,e.set.toData)),a=F(n.projection,r),u=a.reduce((f,d)=>Math.max(f,Math.abs(d)),0)||1,s=new Float64Array(16);for(let f=0;f<4;++f){let[d,p,h,v]=[0,1,2,3].map(_=>a[_+4*f]/u);s.set([this.width/2*(d+v),this.height/2*(p+v),(h+v)/2,v],4*f)}this.frameBlock.write({window_from_local:s,reference:e.set.reference,half_line_width:i?t/2:0,viewport:[this.width,this.height]},["reference"]),this.frameBlock.bind();let c=[...e.layer.planes??[],...this.planes].slice(0,8);if(c.length){let f=F(e.model,e.set.toData),d=j(a),p=new Float64Array(32),h=new Float64Array(32);c.forEach((v,_)=>{let b=[0,1,2,3].map(E=>v[0]*f[4*E]+v[1]*f[4*E+1]+v[2]*f[4*E+2]+v[3]*f[4*E+3]),y=Math.hypot(b[0],b[1],b[2])||1;if(b.forEach((E,w)=>p[4*_+w]=E/y),d)for(let E=0;E<2;++E){let w=[0,1,2,3].reduce((A,m)=>A+p[4*_+m]*d[m+4*E],0);h[4*_+E]=w*u*(2/(E===0?this.width:this.height))}}),this.clipBlock.write({clip_planes:p,clip_tilts:h,clip_plane_count:0,clip_rounding:0}),this.clipBlock.write({clip_plane_count:c.length},["clip_plane_count"]),this.clipBlock.bind()}return{wide:i,clipped:c.length>0}}drawSlice(e,n){let{gl:t}=this,i=null,r=null;for(;e.next<e.jobs.length&&this.sliceSize<n;){let{lines:a,block:u}=e.jobs[e.next++];if(a.set.pointsOf(u),i!==a){i=a;let{wide:s,clipped:c}=this.aim(a,e.matrices),f=["CLIPPING","CLIPPING_DEPTH","EDGES"];s&&f.push("WIDE_LINES"),c&&f.push("CLIP_PLANES"),a.values&&f.push("VALUES_STORED"),a.byPoint&&f.push("VALUES_COLOUR"),a.kept&&f.push("STREAMLINE_MASK"),r=this.program("page/segment.vert","page/segment.frag",f).use(),a.values&&r.set({value_code:a.values.code,shown_values:a.shownValues}),r.uints({layer:a.index*2**28})}t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.texels),t.enable(t.DEPTH_TEST),t.depthFunc(t.LESS),this.frameBlock.bind(),r.use().textures({items:a.set.items,kept:a.kept,value_texels:a.values&&a.values.texture,point_colours:a.byPoint?a.colours:null}),this.sliceSize+=a.set.draw(u,r,e.share)}}present(e){let{gl:n,textures:t,buffers:i}=this;this.repaint(e),n.disable(n.DEPTH_TEST),n.bindFramebuffer(n.FRAMEBUFFER,i.drawn),n.bindVertexArray(null);let r=this.program("page/screen.vert","page/resolve.frag").use(),a=j(e.projection)??ve(),u=0;for(let s of this.lines){if(!s.layer.visible)continue;let{layer:c}=s,{colours:f}=c,d=c.line_width*this.ratio;u=Math.max(u,1-Math.min(1,d)),r.textures({texels:t.texels,depths:t.depths,colours:s.byPoint?null:s.colours,table:s.table}),r.uints({layer:s.index*2**28,marked:s.marked}),r.ints({mode:sn[f.mode],logarithm:f.log?1:0,light:un[c.light]}),r.set({one_colour:f.colour??[1,1,1],table_range:s.tableRange,reflects:c.reflects,sheen:c.sheen,data_to_view:ae(F(e.view,s.model)),pixel_to_view:new Float32Array(a),picture:[this.width,this.height]}),this.setLights(r,e.view),n.drawArrays(n.TRIANGLES,0,3)}if(this.drawTranslucent(e),n.disable(n.DEPTH_TEST),n.bindVertexArray(null),this.scene.antialias&&this.lines.length){n.bindFramebuffer(n.FRAMEBUFFER,i.shown),n.viewport(0,0,this.width+2,this.height+2),this.program("page/screen.vert","page/visible_edges.frag").use().textures({texels:t.texels,depths:t.depths,drawn:t.drawn}).set({narrower:u}),n.drawArrays(n.TRIANGLES,0,3),n.viewport(0,0,this.width,this.height),n.bindFramebuffer(n.FRAMEBUFFER,i.drawn);let s=this.program("page/screen.vert","effects/picture/antialias_coverage.frag").use().textures({shown:t.shown});n.uniform2i(s.at("shift"),1,1),n.drawArrays(n.TRIANGLES,0,3)}n.bindFramebuffer(n.FRAMEBUFFER,null),this.program("page/screen.vert","page/copy.frag").use().textures({drawn:t.drawn}),n.drawArrays(n.TRIANGLES,0,3),this.presented?.()}repaint(e){this.frame&&this.frame.drawn++>0&&this.drawBackdrop(e)}drawTranslucent(e){let{gl:n}=this,t=this.surfaces.filter(u=>u.layer.visible&&u.translucent),i=this.images.filter(u=>u.layer.visible&&u.layer.opacity<1);if(!t.length&&!i.length)return;n.bindFramebuffer(n.FRAMEBUFFER,this.buffers.scene),n.enable(n.DEPTH_TEST),n.depthFunc(n.LEQUAL),n.depthMask(!1),n.enable(n.BLEND),n.blendFunc(n.SRC_ALPHA,n.ONE_MINUS_SRC_ALPHA);let r=this.program("page/surface.vert","page/surface.frag");t.sort((u,s)=>s.depth(e.view)-u.depth(e.view)).forEach(u=>u.draw(r,e));let a=this.program("page/image.vert","page/image.frag");i.forEach(u=>u.draw(a,e)),n.disable(n.BLEND),n.depthMask(!0)}pick(e,n){let{gl:t}=this,i=Math.floor(e*this.ratio),r=this.height-1-Math.floor(n*this.ratio),a=new Uint32Array(4),u=[[0,0],[1,0],[-1,0],[0,1],[0,-1],[2,0],[-2,0],[0,2],[0,-2]];for(let[s,c]of u){if(i+s<0||r+c<0||i+s>=this.width||r+c>=this.height||(t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.texels),t.readPixels(i+s,r+c,1,1,t.RGBA_INTEGER,t.UNSIGNED_INT,a),a[0]===te&&a[1]===te))continue;let f=this.lines[a[0]>>>28];if(!f)continue;let d=f.values?new Float32Array(new Uint32Array([a[3]]).buffer)[0]:null;return{lines:f,streamline:a[0]&268435455,value:d}}return null}placeOf(e,n,t,i){let{camera:r,scene:a,canvas:u}=this,s=u.clientWidth,c=u.clientHeight,f=F(r.projection(this.width/this.height,a.bounds),F(r.view(),e.model)),d=[0,0,0],p=1/0;for(let h of e.set.pointsOfStreamline(n)){let[v,_,,b]=M(f,h),y=Math.hypot((v/b+1)*s/2-t,(1-_/b)*c/2-i);b>0&&y<p&&([d,p]=[h,y])}return d}pixels(){let{gl:e,width:n,height:t}=this,i=new Uint8Array(4*n*t),r=new Uint8Array(i.length);e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.drawn),e.readPixels(0,0,n,t,e.RGBA,e.UNSIGNED_BYTE,i);for(let a=0;a<t;++a)r.set(i.subarray(4*n*a,4*n*(a+1)),4*n*(t-1-a));return r}};var ke=o=>document.getElementById(o)?.textContent??"";async function cn(o){return Promise.all(o.data.map(async(e,n)=>{if(e.file===void 0)return L(ke(`data-${n}`).trim());let t=await fetch(e.file);if(!t.ok)throw new Error(`${e.file} cannot be read (${t.status}); it must lie beside this page.`);return new Uint8Array(await t.arrayBuffer())}))}function De(o){let e=document.getElementById("message");e.textContent=o instanceof Error?o.message:String(o),e.hidden=!1,document.body.dataset.state="failed"}async function ln(){let o=JSON.parse(ke("scene"));document.title=o.title;let e=await cn(o),n=new fe(document.getElementById("view"),o,e);n.failed=De,n.drawnOnce=()=>{document.body.dataset.state="drawn"},new ResizeObserver(()=>n.change()).observe(n.canvas);let t=new se(n,e);Ie(n,(i,r)=>t.pick(i,r)),window.pvfiblets=n}ln().catch(De);})();
